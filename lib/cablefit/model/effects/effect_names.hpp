// Effects of the catalogue by the names that options and campaign files give.
#pragma once

#include <string>
#include <vector>

#include "cablefit/model/effects.hpp"

namespace cablefit {

/// An effect by its name alone: all its values are NaN.
EffectInstance blank_effect(const Effect& row);

/// An effect that an option asks for.
struct WantedEffect {
  const Effect* effect = nullptr;
  int joint = 0;  ///< from 1; 0: each joint
};

/// By name, "stribeck[motor]" on each joint or "stribeck[motor 2]" on one. The side may be left out
/// where there is one only. Throws Error(usage) with what there is.
WantedEffect wanted_effect(const std::string& name);

/// Such effects on a rig of `n_joints` joints. Throws Error(usage) for a joint that it lacks.
EffectsPerJoint blank_effects(const std::vector<std::string>& names, int n_joints);

}  // namespace cablefit
