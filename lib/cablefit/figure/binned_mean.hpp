// The mean of y as a function of x, over bins of x: what a cloud of points does on average.
#pragma once

#include <vector>

#include "cablefit/figure/figure.hpp"
#include "cablefit/figure/growing_bins.hpp"

namespace cablefit {

class BinnedMean {
 public:
  explicit BinnedMean(std::size_t n_bins);

  /// NaN is left out.
  void add(double x, double y);

  /// Fills x and y with the means of every bin that holds at least `min_rows`; NaN between bins
  /// that are not neighbours when `break_at_holes`.
  void draw(Trace& trace, std::size_t min_rows, bool break_at_holes) const;

 private:
  struct Bin {
    double x = 0, y = 0;  ///< sums
    std::size_t n = 0;
  };
  void widen(double x);

  GrowingBins x_;
  std::vector<Bin> bins_;
};

}  // namespace cablefit
