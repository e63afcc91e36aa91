// A controller as a rig file has it.
#pragma once

#include <string>

#include "cablefit/model/rig.hpp"

namespace cablefit {

/// {"type": "pid", "kp": ...} on one line.
std::string controller_text(const Controller& controller);

}  // namespace cablefit
