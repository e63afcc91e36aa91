// Gravity that does not point where the rig file says, as on an arm whose base leans or hangs. The
// weights of all links show it, by the poses of all joints. Internal to refine/.
#pragma once

#include <optional>

#include "cablefit/refine/rig_errors/rig_error.hpp"

namespace cablefit {

/// Of an arm with a chain of joints. Nothing where the logs determine no angle to the direction
/// of the rig file, or it is as good.
std::optional<RigError> wrong_gravity(const RigErrorSearch& search);

}  // namespace cablefit
