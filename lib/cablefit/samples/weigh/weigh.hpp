// Logs weighed before any fit: do their own numbers agree with the units, signs and columns that
// they are read with? What cannot be right is refused, what is odd is warned about before all else.
#pragma once

#include <vector>

#include "cablefit/samples/survey/survey.hpp"

namespace cablefit {

/// Puts what is odd into LogSurvey::warnings. Throws Error(input) for what cannot be right, with
/// its size, its likely cause and the rig line that mends it; with Reading::trust_units that is a
/// warning too. The first cause alone is reported: it explains the rest.
void weigh_logs(std::vector<LogSurvey>& logs);

}  // namespace cablefit
