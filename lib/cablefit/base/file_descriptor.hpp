// Files of the system underneath output_file and streamed_file. Internal to base/.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace cablefit {

/// An open file. Every failure throws std::system_error.
class Descriptor {
 public:
  explicit Descriptor(int number);
  ~Descriptor();
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  void write_all(std::string_view content);
  void flush_to_disk();
  void close();

 private:
  int number_;
};

/// What is there already and is no regular file, e.g. /dev/null: to be written to, not replaced.
bool is_special_file(const std::filesystem::path& path);
/// Opens such a file for writing.
int open_in_place(const std::filesystem::path& path);

/// A new file beside its target, in a folder that is made if missing; removed again unless it was
/// renamed to the target. A target that is a symbolic link stays one.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::filesystem::path& target);
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  void append(std::string_view content) { file_.write_all(content); }
  /// Flushes to disk, closes and takes the target's name.
  void rename_to_target();

 private:
  int create() const;

  std::filesystem::path target_, path_;
  Descriptor file_;
  bool renamed_ = false;
};

}  // namespace cablefit
