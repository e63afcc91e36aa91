// Which torque matters, and what the equations leave beside it. Internal to refine/.
#pragma once

#include "cablefit/refine/steps/refine_bench.hpp"

namespace cablefit {

/// Per equation that has rows: the residual beyond the noise floor, N m rms, and the torque below
/// which it does not matter: `given`, else 1 % of the rms torque of the equation or 20 % of the
/// noise, whichever is larger. The torque of the link's equation is that of the cables; the noise
/// is the rig's of tau (motor and blocked link), else the floor.
std::vector<EquationRemainder> remainders_of(const Design& design, const Eigen::VectorXd& x,
                                             const KindLevels& floor, double block_seconds,
                                             std::optional<double> given);

inline constexpr double kMaterialShare = 0.01, kMaterialNoise = 0.2;

}  // namespace cablefit
