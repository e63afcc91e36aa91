// A pulley whose radius is not that of the rig file, or a joint that a cable moves though the rig
// file says that it does not. Every joint that the cable passes shows it, by the motion of the
// pulley's joint. Internal to refine/.
#pragma once

#include <optional>

#include "cablefit/refine/rig_errors/rig_error.hpp"

namespace cablefit {

/// The pulley whose radius explains most; several where none alone is significant. Nothing where
/// they are not either.
std::optional<RigError> wrong_radius(const RigErrorSearch& search);

}  // namespace cablefit
