// The table's row of a parameter that a result names.
#pragma once

#include <string_view>

#include "cablefit/base/parameter.hpp"

namespace cablefit {

/// "f_v", or "f_v[2]" of one of several joints. nullptr: no effect has it (a coefficient of a
/// cable, theta_0).
const ParameterInfo* effect_parameter(std::string_view name);

}  // namespace cablefit
