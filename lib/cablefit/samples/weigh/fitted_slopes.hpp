// What a torque follows among channels that vary together, by least squares.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace cablefit {

/// Per column; 0 for one that does not vary. No values where there are fewer than ten rows per
/// column, where no column varies or they are dependent, and where they leave more than half of the
/// variance.
struct FittedSlopes {
  Eigen::VectorXd value, sd;  ///< sd by the scatter, as if that were white
  bool is_known() const { return value.size() > 0; }
  /// Ten sd: friction, which is in the scatter, lasts longer than a sample.
  bool is_clear(Eigen::Index k) const { return std::abs(value(k)) > 10 * sd(k); }
};

/// Least squares of y by the columns and a constant. `columns`: samples x columns; `y`: samples.
FittedSlopes fitted_slopes(const Eigen::MatrixXd& columns, const Eigen::VectorXd& y);

}  // namespace cablefit
