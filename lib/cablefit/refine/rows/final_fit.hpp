// The values that are reported: a QR of the weighted rows; covariance by blocks of time, the
// nonlinear parameters beside the linear ones. Internal to refine/.
#pragma once

#include "cablefit/refine/rows/evidence.hpp"

namespace cablefit {

/// Values and covariance of all linear columns of a design, then of every nonlinear parameter of
/// what was added that was looked for on a range, in order; then of the dates of events.
struct FinalFit {
  Eigen::VectorXd x;              ///< linear columns
  Eigen::MatrixXd covariance;     ///< jackknife over blocks; NaN for what rows do not determine
  double degrees_of_freedom = 1;  ///< blocks less parameters, for t quantiles
  KindLevels rms{};
};

/// Rows weighted by 1/level^2. `undone`: the design before anything was added, which the derivative
/// by a nonlinear parameter needs.
FinalFit final_fit(const Design& undone, const Design& design, const KindLevels& levels,
                   double block_seconds);

/// What the linear columns [first, first + n) carry, N m rms over the rows where they act.
double carried_torque(const Design& design, const Eigen::VectorXd& x, Eigen::Index first,
                      Eigen::Index n);

/// Place of each added variant's first linear column.
std::vector<Eigen::Index> first_columns(const Design& design);

}  // namespace cablefit
