// The reported values: a QR of the weighted rows, and a covariance by blocks of time that includes
// the nonlinear parameters. Internal to refine/.
#pragma once

#include "cablefit/refine/rows/evidence.hpp"

namespace cablefit {

/// Values of all linear columns of a design. The covariance is of these, then of every nonlinear
/// parameter of added effects that was fitted on a range, in order, then of the times of events.
struct FinalFit {
  Eigen::VectorXd x;              ///< linear columns
  Eigen::MatrixXd covariance;     ///< jackknife over blocks; NaN: not determined
  double degrees_of_freedom = 1;  ///< blocks less parameters, for t quantiles
  KindLevels rms{};
};

/// Rows are weighted by 1/level^2. `undone`: the design before any effect was added, which the
/// derivative by a nonlinear parameter needs.
FinalFit final_fit(const Design& undone, const Design& design, const KindLevels& levels,
                   double block_seconds);

/// Torque of the linear columns [first, first + n), N m rms over the rows where they act.
double carried_torque(const Design& design, const Eigen::VectorXd& x, Eigen::Index first,
                      Eigen::Index n);

/// Place of each added variant's first linear column.
std::vector<Eigen::Index> first_columns(const Design& design);

}  // namespace cablefit
