// Whether test logs are simulated in closed loop or by a replay of their torque, which drifts
// whatever the model.
#pragma once

#include <optional>
#include <string_view>

#include "cablefit/refine/refine_options.hpp"
#include "cablefit/samples/plan/decision.hpp"

namespace cablefit {

/// Name of the decision, by which a report finds it.
inline constexpr std::string_view kReplayedTorque = "torque replay";

/// The first log with a moving part whose torque is replayed, and why; nothing where all are
/// simulated in closed loop.
std::optional<Decision> replayed_torque(const RefineLogs& logs);

}  // namespace cablefit
