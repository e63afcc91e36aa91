// What several joints have beyond the paper's model, as one list per joint.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "cablefit/model/effects.hpp"
#include "cablefit/model/model.hpp"

namespace cablefit {

bool any_effect(const EffectsPerJoint& effects);
/// One list for each joint. Throws Error(usage) when there are more lists than joints.
EffectsPerJoint of_joints(EffectsPerJoint effects, int n_joints);
EffectsPerJoint added_effects(const Model& model);
/// One list for each of the model's joints.
void set_added_effects(EffectsPerJoint effects, Model& model);

/// Name in results of a parameter of joint `joint` (from 0): "stribeck[motor].a", or
/// "stribeck[motor].a[2]" when there are several joints.
std::string added_parameter_name(const Effect& row, const ParameterInfo& info, int joint,
                                 int n_joints);
/// The parameter of that name, of as many joints as there are lists; nullptr: no effect has it.
Estimate* find_parameter(EffectsPerJoint& effects, std::string_view name);

}  // namespace cablefit
