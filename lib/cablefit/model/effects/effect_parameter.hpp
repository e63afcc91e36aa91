// The table's row of a parameter that a result names.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "cablefit/base/parameter.hpp"
#include "cablefit/model/effects.hpp"

namespace cablefit {

/// "f_v", or "f_v[2]" of one of several joints. nullptr: no effect has it (a coefficient of a
/// cable, theta_0).
const ParameterInfo* effect_parameter(std::string_view name);

/// Name in results of a parameter of an effect beyond the paper's: "stribeck[motor].a".
std::string added_parameter_name(const Effect& row, const ParameterInfo& info);
/// The parameter of that name; nullptr: none of the effects has it.
Estimate* find_parameter(std::vector<EffectInstance>& effects, std::string_view name);

}  // namespace cablefit
