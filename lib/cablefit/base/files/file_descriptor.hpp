// Files of the system underneath output_file and streamed_file. Internal to base/.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "cablefit/base/files/temporary_name.hpp"

namespace cablefit {

/// An open file. Every failure throws std::system_error.
class Descriptor {
 public:
  explicit Descriptor(int number);
  ~Descriptor();
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  void write_all(std::string_view content) const;
  void flush_to_disk() const;
  void close();
  int number() const { return number_; }

 private:
  int number_;
};

/// What is there already and is no regular file, e.g. /dev/null: to be written to, not replaced.
bool is_special_file(const std::filesystem::path& path);
/// Opens such a file for writing.
int open_in_place(const std::filesystem::path& path);

/// A new file in the folder of its target, which is made if missing; gone again unless it was
/// renamed to the target. It has no name until then where the file system allows for that, so that
/// nothing is left of a process that is killed. A target that is a symbolic link stays one.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::filesystem::path& target);
  ~TemporaryFile() = default;
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  void append(std::string_view content) { file_.write_all(content); }
  /// Flushes to disk, closes and takes the target's name.
  void rename_to_target();

 private:
  int create(const std::filesystem::path& folder);
  /// False when a file of that name exists.
  bool give_name(const char* path) const;

  std::filesystem::path target_;
  std::optional<TemporaryName> name_;
  Descriptor file_;
};

}  // namespace cablefit
