// Names of files that are not finished, ".cablefit-PID-N.tmp" beside their targets: whatever ends
// the process, they are removed, at the latest by the next run that writes to the folder. Internal
// to base/.
#pragma once

#include <cstddef>
#include <filesystem>

namespace cablefit {

/// A name beside `target` that no file has. The file that is given it is removed again by the
/// destructor and by remove_temporaries() (output_file.hpp), unless keep() was called.
class TemporaryName {
 public:
  explicit TemporaryName(const std::filesystem::path& target);
  ~TemporaryName();
  TemporaryName(const TemporaryName&) = delete;
  TemporaryName& operator=(const TemporaryName&) = delete;

  const char* c_str() const { return path_.c_str(); }
  void keep();

 private:
  std::filesystem::path path_;
  std::size_t slot_;
};

/// Removes files of such names that a killed process left in `folder`: whoever writes one holds a
/// lock on it. Looks once per folder, and never fails.
void remove_leftovers(const std::filesystem::path& folder) noexcept;

}  // namespace cablefit
