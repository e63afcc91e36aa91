// A scatter plot of any number of rows: one real point for every occupied cell of a grid, so that
// the outline of the cloud and every outlier stay. For drawing only.
#pragma once

#include <vector>

#include "cablefit/figure/figure.hpp"
#include "cablefit/figure/growing_bins.hpp"

namespace cablefit {

class PointCloud {
 public:
  /// At most n_x * n_y points, and at least a quarter as fine over the range seen.
  explicit PointCloud(std::size_t n_x = 96, std::size_t n_y = 64);

  /// NaN is left out.
  void add(double x, double y);

  /// Fills x and y.
  void draw(Trace& trace) const;

 private:
  void widen(double x, double y);
  std::size_t cell(double x, double y) const { return y_.bin_of(y) * n_x_ + x_.bin_of(x); }

  std::size_t n_x_;
  GrowingBins x_, y_;
  std::vector<bool> occupied_;
  std::vector<double> points_x_, points_y_;
};

}  // namespace cablefit
