// The unit of a joint's torque, which is a force on a linear axis.
#pragma once

#include <string>

namespace cablefit {

inline std::string torque_unit(bool linear_motion) { return linear_motion ? "N" : "N m"; }

}  // namespace cablefit
