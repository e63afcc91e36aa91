// A fit's values with physically possible inertias, frictions and stiffnesses, for simulations and
// model files. Internal to refine/.
#pragma once

#include "cablefit/refine/rows/final_fit.hpp"

namespace cablefit {

/// The least squares values `x` with physical bounds. An inertia that is not positive becomes the
/// rig's "cad", else the value whose torque is kLeastTorque of the rms torque. A negative friction
/// becomes 0, as does a negative stiffness of a spring or of a cable at zero elongation (a cable
/// can only pull). All others are fitted again. Without such values the result is `x` itself, to
/// the last bit. The search uses plain least squares, because a missing effect may make a friction
/// negative. `on_bound`, when given: the columns at a bound.
Eigen::VectorXd physical_values(const Design& design, double block_seconds,
                                const KindLevels& levels, const Eigen::VectorXd& x,
                                std::vector<Eigen::Index>* on_bound = nullptr);

inline constexpr double kLeastTorque = 0.003;

/// Replaces the values `x` of the fit by these; those at a bound have no sd.
void take_physical(const Design& design, double block_seconds, const KindLevels& levels,
                   const Eigen::VectorXd& x, FinalFit& fit);

}  // namespace cablefit
