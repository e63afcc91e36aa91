// How far the latest pass over a file is, for a display on another thread. One per process: files
// are opened deep inside of fits, which should not have to carry a display through; and no result
// depends on it. Reading costs one relaxed addition per block of bytes.
#pragma once

#include <cstdint>
#include <string>

namespace cablefit {

struct ReadProgress {
  std::string path;              ///< empty: no file of a size worth telling was opened yet
  std::uint64_t n_passes = 0;    ///< over any file, the present one included
  std::uint64_t n_bytes = 0;     ///< taken from the file, packed ones as they are
  std::uint64_t n_expected = 0;  ///< its size when it was opened
  double began = 0;              ///< s on the steady clock
};

ReadProgress read_progress();
/// Seconds on the clock of `began`.
double steady_seconds();

/// For readers of files: a pass over `path` begins, and goes on.
void begin_pass(const std::string& path, std::uint64_t n_expected);
void count_read(std::uint64_t n_bytes);

}  // namespace cablefit
