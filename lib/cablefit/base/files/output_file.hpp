// Results appear whole or not at all: written beside the target under a temporary name, flushed to
// disk, then renamed.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "cablefit/base/error.hpp"

namespace cablefit {

/// Creates missing parent folders. "-" writes to standard output. Throws Error(output) naming the
/// path and the system's reason; nothing is left behind then.
void write_whole(const std::string& path, std::string_view content);

/// Files of one run that appear together: all are written beside their targets, then all are
/// renamed.
class WholeFiles {
 public:
  WholeFiles();
  /// Leaves nothing behind unless finish() was called.
  ~WholeFiles();
  WholeFiles(const WholeFiles&) = delete;
  WholeFiles& operator=(const WholeFiles&) = delete;

  /// Paths and failures as of write_whole(); devices and "-" are written to by finish().
  void add(const std::string& path, std::string content);
  void finish();

 private:
  struct File;
  std::vector<std::unique_ptr<File>> files_;
};

/// "cannot write PATH: the system's reason".
Error output_error(const std::string& path, const std::system_error& failure);

/// Removes what is written at this moment and not finished. For signal handlers; the process must
/// end afterwards.
void remove_temporaries() noexcept;

}  // namespace cablefit
