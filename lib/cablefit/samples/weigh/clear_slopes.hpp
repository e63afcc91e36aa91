// What a torque follows among channels that vary together, by least squares.
#pragma once

#include <Eigen/Core>

namespace cablefit {

/// Least-squares coefficients of y by the columns and a constant; 0: within ten standard deviations
/// of 0 by the scatter, or the column does not vary. Empty where the columns are dependent or leave
/// more than half of y's variance. `columns`: samples x columns; `y`: samples.
Eigen::VectorXd clear_slopes(const Eigen::MatrixXd& columns, const Eigen::VectorXd& y);

}  // namespace cablefit
