// Logs of one bench under different loads: each rig file has the load of its log.
#pragma once

#include <vector>

#include "cablefit/samples/survey/survey.hpp"

namespace cablefit {

/// Where rig files of one preload differ in their load alone, the load law of each log becomes its
/// tau_load channel, as if it had been logged: one fit then takes them all. Warns where a load has
/// an inertia of its own, which J_link then includes, and of ropes, which are not checked. Other
/// logs stay as they are.
void make_load_channels(std::vector<LogSurvey>& logs);

}  // namespace cablefit
