// How far the clock of a log is off from row to row, which positions of one row have in common.
#pragma once

#include <Eigen/Core>

namespace cablefit {

/// Positions of link and motor of one joint on even rows; a blocked link has no q.
struct PositionPair {
  Eigen::ArrayXd q, theta;
};

/// sd of the time error of a row, s: a row read dt late shows q + qd dt and theta + thetad dt, so
/// that the noise of both moves together, the more the faster they are. From the covariance of
/// their sixth differences, less that of the `simulated` motion on the same rows, over the mean of
/// `speeds` (qd * thetad per row). 0 when it is within kJitterSd of what independent noise shows by
/// chance.
double clock_jitter(const PositionPair& measured, const PositionPair& simulated,
                    const Eigen::ArrayXd& speeds);

inline constexpr double kJitterSd = 4;

}  // namespace cablefit
