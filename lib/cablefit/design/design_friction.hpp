// Dry friction of a joint under load, and its efficiency. Internal to design/.
#pragma once

#include <optional>

#include "cablefit/design/design_result.hpp"
#include "cablefit/design/joint_curve.hpp"
#include "cablefit/model/model.hpp"

namespace cablefit {

/// Of slow motion: every dry level of the joint's effects and refinements on both sides (f_s, f_sm,
/// friction that grows with tension, ...) at the deflections of no load and of `torque`, plus
/// `tension_friction` times the tensions at the motor's pulleys. Nothing when there is none.
std::optional<DesignFriction> design_friction(const Model& model, const JointCurve& curve,
                                              double torque,
                                              std::optional<double> tension_friction);

}  // namespace cablefit
