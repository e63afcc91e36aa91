// The position controllers of logs whose rig file names none. Internal to session/.
#pragma once

#include <optional>
#include <vector>

#include "cablefit/model/model.hpp"
#include "cablefit/refine/refine_options.hpp"
#include "cablefit/samples/plan/decision.hpp"

namespace cablefit {

/// Gives the logs and the models the controllers that made the torques of the moving training logs,
/// so that their closed loop can be simulated: a replay of the torque drifts. Nothing where a rig
/// file names a controller, or none explains the torque of a joint; nothing is changed then.
std::optional<Decision> take_found_controller(RefineLogs& logs, std::vector<Model>& models);

}  // namespace cablefit
