#include "cablefit/model/effects/effects_per_joint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "cablefit/base/error.hpp"
#include "cablefit/model/effects/effect_parameter.hpp"

namespace cablefit {

bool any_effect(const EffectsPerJoint& effects) {
  return std::any_of(effects.begin(), effects.end(), [](const auto& own) { return !own.empty(); });
}

EffectsPerJoint of_joints(EffectsPerJoint effects, int n_joints) {
  const auto n = static_cast<std::size_t>(n_joints);
  if (effects.size() > n)
    throw usage_error(
        fmt::format("effects of {} joints are given, and the rig file has {}", effects.size(), n),
        "give at most one list of effects for each joint");
  effects.resize(n);
  return effects;
}

EffectsPerJoint added_effects(const Model& model) {
  EffectsPerJoint effects;
  for (const JointModel& joint : model.joints) effects.push_back(joint.added);
  return effects;
}

void set_added_effects(EffectsPerJoint effects, Model& model) {
  effects.resize(model.joints.size());
  for (std::size_t k = 0; k < effects.size(); ++k) model.joints[k].added = std::move(effects[k]);
}

std::string added_parameter_name(const Effect& row, const ParameterInfo& info, int joint,
                                 int n_joints) {
  return joint_parameter_name(added_parameter_name(row, info), joint + 1, n_joints);
}

Estimate* find_parameter(EffectsPerJoint& effects, std::string_view name) {
  const auto n_joints = static_cast<int>(effects.size());
  for (int joint = 0; joint < n_joints; ++joint)
    for (EffectInstance& effect : effects[static_cast<std::size_t>(joint)])
      for (std::size_t k = 0; k < effect.parameters.size(); ++k)
        if (name ==
            added_parameter_name(*effect.effect, effect.effect->parameters[k], joint, n_joints))
          return &effect.parameters[k];
  return nullptr;
}

}  // namespace cablefit
