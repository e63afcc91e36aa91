// The torque that matters, and the residual of each equation beside it. Internal to refine/.
#pragma once

#include "cablefit/refine/steps/refine_bench.hpp"

namespace cablefit {

/// For each equation with rows: the residual beyond the noise floor, N m rms, and the torque below
/// which it does not matter. That is `given`, else 1 % of the rms torque of the equation or 20 % of
/// the noise, whichever is larger. The torque of the link's equation is that of the cables. The
/// noise is the rig's of tau (motor and blocked link), else the floor.
std::vector<EquationRemainder> remainders_of(const Design& design, const Eigen::VectorXd& x,
                                             const KindLevels& floor, double block_seconds,
                                             std::optional<double> given);

inline constexpr double kMaterialShare = 0.01, kMaterialNoise = 0.2;

}  // namespace cablefit
