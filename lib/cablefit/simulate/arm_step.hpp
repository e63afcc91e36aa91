// The step of a simulation whose links move each other, where the user gives none.
#pragma once

#include "cablefit/model/model.hpp"

namespace cablefit {

/// Circular frequency (rad/s) of the stiffest mode of motors, cables and links in the reference
/// pose: the largest eigenvalue of diag(M(q), J_motor)^-1 K, K the Hessian of the elastic energy,
/// on either side of it (1 mrad), where cables that are taut on one side only count. 0: none.
double stiffest_mode(const Model& model);

/// s. kArmShare of the mode's 1/omega, from the step of independent joints (25 us) up to twice
/// that: a mode's phase is off by (h omega)^2 / 24, 4e-5 of it. Links that move each other cost
/// more than ten of the others' steps.
inline constexpr double kArmShare = 0.03;
double arm_step(double stiffest_mode);

}  // namespace cablefit
