// The channels of a log over time, for looking at it.
#pragma once

#include <vector>

#include "cablefit/figure/figure.hpp"
#include "cablefit/samples/survey/survey.hpp"

namespace cablefit {

/// One more pass over the log: positions, velocity and torques of every part and joint, as they are
/// in the log, in SI.
std::vector<Figure> check_figures(const LogSurvey& log);

}  // namespace cablefit
