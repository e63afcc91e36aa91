// `cablefit simulate`: the model is run on the input of every log and compared with what was
// measured.
#pragma once

#include <span>
#include <string>

#include "cablefit/simulate/experiment.hpp"
#include "cablefit/simulate/simulate_result.hpp"

namespace cablefit {

/// Simulates every part of the logs (survey_for_simulation): blocked ones with the link held.
/// Where a log has parts of the model's preload, only those. A part that diverges ends there and
/// says so. Throws Error(input) for missing channels and when nothing is left to simulate,
/// Error(output) when the trajectories cannot be written.
SimulateResult simulate_logs(const Model& model, std::span<const LogSurvey> logs,
                             const ReplayOptions& options);

}  // namespace cablefit
