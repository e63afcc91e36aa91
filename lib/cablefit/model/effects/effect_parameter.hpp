// The table's row of a parameter that a result names.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "cablefit/base/parameter.hpp"
#include "cablefit/model/effects.hpp"

namespace cablefit {

/// "f_v" or "stribeck[motor].a", of one of several joints with its index: "f_v[2]". nullptr: no
/// effect has it (a coefficient of a cable, theta_0).
const ParameterInfo* effect_parameter(std::string_view name);

/// Name in results of a parameter of an effect beyond the paper's on a rig of one joint:
/// "stribeck[motor].a".
std::string added_parameter_name(const Effect& row, const ParameterInfo& info);

/// A shape that may be 0: a model file may leave it out, and then it is 0. `parameter`: its place
/// among those of the row.
bool may_be_left_out(const Effect& row, std::size_t parameter);

}  // namespace cablefit
