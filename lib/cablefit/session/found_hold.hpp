// Whether the torque of the logs is held, and for how long, where their rig files leave it open.
// Internal to session/.
#pragma once

#include <optional>
#include <vector>

#include "cablefit/model/model.hpp"
#include "cablefit/refine/refine_options.hpp"
#include "cablefit/refine/refine_result.hpp"
#include "cablefit/samples/plan/decision.hpp"

namespace cablefit {

/// Whether no rig file says how the torque is held.
bool is_hold_open(const RefineLogs& logs, const std::vector<Model>& models);

/// How the torque is held by the time at which it acts: not at all, over a row of the log, or over
/// a part of it, as where the log keeps every second or fourth row of a drive. Logs and models get
/// that, where no rig file says it. Nothing where the torque acts at another time.
///
/// A blocked log with a longer sample period than the moving logs keeps every n-th torque of the
/// same drive, or comes from a slower drive. It is the same drive where its torque acts no later.
/// Logs and models then get the period of this drive, where no rig file gives one.
std::vector<Decision> take_fitted_hold(RefineLogs& logs, std::vector<Model>& models);

/// The hold by a delay of the torque that refine identified, where that means another hold: refine
/// has to begin anew then.
std::optional<Decision> take_found_hold(const RefineResult& result, RefineLogs& logs,
                                        std::vector<Model>& models);

}  // namespace cablefit
