// Effects of the catalogue by the names that options and campaign files give.
#pragma once

#include <string>
#include <vector>

#include "cablefit/model/effects.hpp"

namespace cablefit {

/// An effect by its name alone: all its values are NaN.
EffectInstance blank_effect(const Effect& row);

/// Such effects by name, "stribeck[motor]"; the side may be left out where there is one only.
/// Throws Error(usage) with what there is.
std::vector<EffectInstance> blank_effects(const std::vector<std::string>& names);

}  // namespace cablefit
