// Dry friction of a joint under load, and its efficiency. Internal to design/.
#pragma once

#include <optional>
#include <span>

#include "cablefit/design/curves/joint_curve.hpp"
#include "cablefit/design/design_result.hpp"
#include "cablefit/model/model.hpp"

namespace cablefit {

/// Dry level of the joint (N m) at the deflection phi, moving slowly in this direction: that of
/// every effect and refinement on both sides (f_s, f_sm, friction that grows with tension, ...),
/// plus `tension_friction` times the tensions at the motor's pulleys.
double friction_at(const Model& model, const JointCurve& curve, double phi, double direction,
                   double tension_friction);

/// Of slow motion, without load and at `torque`. With `tension_friction`, or when the model itself
/// has friction that grows with the tension, that is how it depends on the preload; else `curves`
/// say it, and the part that depends on the load is the model's. Nothing where it is not known.
std::optional<DesignFriction> design_friction(const Model& model, const JointCurve& curve,
                                              double torque, std::optional<double> tension_friction,
                                              std::span<const FrictionCurve> curves);

}  // namespace cablefit
