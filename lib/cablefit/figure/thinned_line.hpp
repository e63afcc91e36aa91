// A signal of any length for a plot some thousand pixels wide: the least and the greatest value of
// every stretch of time, so that no peak is lost. For drawing only; nothing is ever fitted to it.
#pragma once

#include <cstddef>
#include <vector>

#include "cablefit/figure/figure.hpp"

namespace cablefit {

inline constexpr std::size_t kMostBuckets = 2000;

class ThinnedLine {
 public:
  /// Times from `begin` to `end`; `spacing`: of the rows, all in s. Buckets are never shorter than
  /// that, so that an empty one is a hole in the data and not a matter of rounding.
  ThinnedLine(double begin, double end, double spacing);

  /// In any order; times outside count to the first or last bucket. NaN is a missing value.
  void add(double t, double value);

  /// Fills x and y, at most two points a bucket in order of time, and a NaN for every hole.
  void draw(Trace& trace) const;

 private:
  struct Bucket {
    double t_low = 0, low = 0, t_high = 0, high = 0;
    bool filled = false;
  };
  void draw_bucket(const Bucket& bucket, bool alone, Trace& trace) const;

  double begin_, width_;
  std::vector<Bucket> buckets_;
};

}  // namespace cablefit
