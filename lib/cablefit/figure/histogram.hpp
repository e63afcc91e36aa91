// How residuals are distributed, against the normal curve.
#pragma once

#include <cstddef>
#include <vector>

#include "cablefit/figure/figure.hpp"

namespace cablefit {

/// Of values divided by their rms, over -kHistogramReach..kHistogramReach.
inline constexpr double kHistogramReach = 5;

class Histogram {
 public:
  Histogram();

  /// A standardized value; NaN is left out.
  void add(double value);

  /// Density per unit of the standardized value, at the middle of the bins.
  void draw(Trace& trace) const;
  /// Share of the values that lie beyond the reach, 0..1.
  double share_beyond() const;

  /// The density of the standard normal distribution over the reach.
  static void draw_normal(Trace& trace);

 private:
  std::vector<std::size_t> counts_;
  std::size_t n_ = 0, n_beyond_ = 0;
};

}  // namespace cablefit
