// A fit's values with inertias, frictions and stiffnesses that a robot can have: what is simulated,
// and written into a model. Internal to refine/.
#pragma once

#include "cablefit/refine/rows/final_fit.hpp"

namespace cablefit {

/// The least squares values `x` with physical bounds: an inertia that is not positive becomes the
/// rig's "cad", else the value whose torque is kLeastTorque of the rms torque; a negative friction
/// becomes 0, as does a negative stiffness of a spring or of a cable at zero elongation (a cable
/// can only pull); all others are fitted again. Without such values `x` itself, to the last bit.
/// The search goes on with plain least squares: a missing effect may make a friction negative.
/// `on_bound`, when given: the columns that stand on a bound.
Eigen::VectorXd physical_values(const Design& design, double block_seconds,
                                const KindLevels& levels, const Eigen::VectorXd& x,
                                std::vector<Eigen::Index>* on_bound = nullptr);

inline constexpr double kLeastTorque = 0.003;

/// Gives the fit these values in place of `x`; those on a bound have no sd.
void take_physical(const Design& design, double block_seconds, const KindLevels& levels,
                   const Eigen::VectorXd& x, FinalFit& fit);

}  // namespace cablefit
