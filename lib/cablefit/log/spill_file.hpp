// Numbers stored outside memory, in an unlinked temporary file: it disappears with the process,
// however that ends.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace cablefit {

class SpillFile {
 public:
  SpillFile() = default;
  ~SpillFile();
  SpillFile(const SpillFile&) = delete;
  SpillFile& operator=(const SpillFile&) = delete;

  /// How many numbers were appended.
  std::size_t size() const { return n_written_ + tail_.size(); }
  /// Both throw Error(output) when the temporary folder has no room.
  void append(double value) {
    if (tail_.size() >= kTailSize) flush();
    tail_.push_back(value);
  }
  void append(std::span<const double> values);
  /// Copies the numbers from index `first` on; all of them must have been appended. Several threads
  /// may read at once.
  void read(std::size_t first, std::span<double> to) const;

 private:
  static constexpr std::size_t kTailSize = 1u << 17;  // small logs never reach the disk

  static constexpr std::size_t kLongRun = 1u << 12;  // a write costs less than copying it first

  void flush();
  void write(std::span<const double> values);

  int descriptor_ = -1;  // opened by the first flush()
  std::size_t n_written_ = 0;
  std::vector<double> tail_;  // what follows the numbers in the file
};

}  // namespace cablefit
