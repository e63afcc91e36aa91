// A file opened for reading; every failure is an Error(input) with the system's reason.
#pragma once

#include <cstddef>
#include <string>

namespace cablefit {

class FileReader {
 public:
  explicit FileReader(std::string path);
  ~FileReader();
  FileReader(const FileReader&) = delete;
  FileReader& operator=(const FileReader&) = delete;

  const std::string& path() const { return path_; }
  /// Up to `n_bytes` (> 0) bytes, fewer only near the end; 0 at the end.
  std::size_t read(char* to, std::size_t n_bytes);

 private:
  std::string path_;
  int descriptor_;
};

}  // namespace cablefit
