// Means of a residual over windows of 1, 2, 4, ... rows: the square root of an Allan-like variance
// without differences (Allan 1966), since a detector's threshold does not move with the mean.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "cablefit/base/window_mean.hpp"

namespace cablefit {

class WindowMeans {
 public:
  /// Consecutive rows: places on the time grid, ascending over all calls, and values. A window in
  /// which a row is missing does not count.
  void add(std::span<const Eigen::Index> numbers, const Eigen::Ref<const Eigen::VectorXd>& values);
  /// Of every length that kFewWindows windows or more are there of. `row_seconds`: between rows.
  std::vector<WindowMean> result(double row_seconds) const;

 private:
  static constexpr std::size_t kLengths = 16;
  static constexpr double kFewWindows = 16;
  struct Length {
    Eigen::Index window = -1, n_rows = 0;
    double sum = 0, squares = 0, n_windows = 0;
  };
  std::array<Length, kLengths> lengths_;
};

}  // namespace cablefit
