// The state a simulation starts from, out of noisy, rounded positions. Internal to simulate/.
#pragma once

#include <Eigen/Core>

namespace cablefit {

struct StartState {
  double position = 0, velocity = 0;  ///< rad, rad/s
};

/// Rows that start_state() likes to have on either side.
inline constexpr Eigen::Index kStartRows = 32;

/// A cubic fitted by least squares to the `positions` (rad, `period` s apart) around `row`, as many
/// rows to both sides as follow a cubic to within the noise (sd, rad): slow motion is smoothed over
/// many rows, fast motion over few. At the ends it is one-sided. Velocity exactly 0 where all those
/// positions are the same.
StartState start_state(const Eigen::Ref<const Eigen::ArrayXd>& positions, Eigen::Index row,
                       double period, double noise);

}  // namespace cablefit
