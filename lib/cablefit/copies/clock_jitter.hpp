// Time error of a log's clock from row to row. All positions of one row have it in common.
#pragma once

#include <Eigen/Core>

namespace cablefit {

/// Positions of link and motor of one joint on even rows; a blocked link has no q.
struct PositionPair {
  Eigen::ArrayXd q, theta;
};

/// sd of the time error of a row, s. A row read dt late shows q + qd dt and theta + thetad dt, so
/// the noise of both is correlated, and more so at high speed. Computed from the covariance of
/// their sixth differences, less that of the `simulated` motion on the same rows, over the mean of
/// `speeds` (qd * thetad per row). 0 when it is within kJitterSd of the covariance that independent
/// noise shows under the null.
double clock_jitter(const PositionPair& measured, const PositionPair& simulated,
                    const Eigen::ArrayXd& speeds);

inline constexpr double kJitterSd = 4;

}  // namespace cablefit
