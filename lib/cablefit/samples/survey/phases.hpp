// Which phases a log has.
#pragma once

#include "cablefit/samples/survey/survey.hpp"

namespace cablefit {

/// Whether a part of the log is of this phase.
bool has_phase(const LogSurvey& log, Phase phase);

}  // namespace cablefit
