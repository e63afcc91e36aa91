// Equal bins over a range that is not known beforehand: when a value falls outside, the bins double
// in width and neighbours are joined. Constant memory, one pass, the same result for the same order
// of rows.
#pragma once

#include <cstddef>

namespace cablefit {

class GrowingBins {
 public:
  explicit GrowingBins(std::size_t n_bins) : n_(n_bins) {}

  /// Whether `value` has a bin already; if not, widen() until it has.
  bool covers(double value) const;
  /// Doubles the width, towards `value`. Bin k of before is bin (k + shift()) / 2 from now on; the
  /// first call only sets the range up and moves nothing.
  void widen(double value);
  std::size_t shift() const { return shift_; }
  bool is_set() const { return width_ > 0; }

  std::size_t bin_of(double value) const;  ///< of a covered value
  double width() const { return width_; }

 private:
  std::size_t n_;
  double begin_ = 0, width_ = 0;
  std::size_t shift_ = 0;
};

}  // namespace cablefit
