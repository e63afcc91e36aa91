// A file too long for memory that appears whole or not at all: written piece by piece beside its
// target under a temporary name, renamed at the end.
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace cablefit {

class StreamedFile {
 public:
  /// Creates missing parent folders. Throws Error(output) naming the path and the system's reason,
  /// as do the others. A device or pipe is written to as it is.
  explicit StreamedFile(const std::string& path);
  /// Leaves nothing behind unless finish() was called.
  ~StreamedFile();
  StreamedFile(const StreamedFile&) = delete;
  StreamedFile& operator=(const StreamedFile&) = delete;

  void append(std::string_view text);
  void finish();

 private:
  class Target;
  template <typename Action>
  void guarded(Action action);
  void write_buffer();

  std::string path_, buffer_;
  std::unique_ptr<Target> target_;
};

}  // namespace cablefit
