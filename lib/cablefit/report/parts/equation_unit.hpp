// The unit of the torque of an equation.
#pragma once

#include <string>

#include "cablefit/dynamic/dynamic_result.hpp"

namespace cablefit {

/// "N m", or "N" where the equation's joint slides: "rigid[3]" is about the third. "N m or N" where
/// that is not known.
std::string equation_unit(const DynamicPreload& preload, const std::string& equation);

}  // namespace cablefit
