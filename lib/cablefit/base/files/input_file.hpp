// A file opened for reading; every failure is an Error(input) with the system's reason.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace cablefit {

/// Identifies one state of a file: equal stamps mean that it was not changed between two reads.
struct FileStamp {
  std::uint64_t device = 0, number = 0, size = 0;
  std::int64_t seconds = 0, nanoseconds = 0;  ///< time of the last write
  bool operator==(const FileStamp&) const = default;
};

/// Throws Error(input) when there is no such file.
FileStamp stamp_of(const std::string& path);

class FileReader {
 public:
  explicit FileReader(std::string path);
  ~FileReader();
  FileReader(const FileReader&) = delete;
  FileReader& operator=(const FileReader&) = delete;

  const std::string& path() const { return path_; }
  /// Reads up to `n_bytes` (> 0) bytes: fewer only near the end of the file, 0 at its end.
  std::size_t read(char* to, std::size_t n_bytes);

 private:
  std::string path_;
  int descriptor_;
};

}  // namespace cablefit
