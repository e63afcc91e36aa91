// The method's floor (dynamic/method_floor.hpp) in the intervals of the one step.
#pragma once

#include <vector>

#include "cablefit/identify/elongations/judged_point.hpp"
#include "cablefit/identify/equations/preload_jobs.hpp"
#include "cablefit/identify/identify.hpp"

namespace cablefit {

/// Widens sd and interval of every parameter by what filter, differences, rounding and an uneven
/// clock do to it, measured per preload on simulated copies of its motion with the fitted cables;
/// what several preloads do to a parameter that they share adds up. `estimates`: one per parameter
/// of the layout.
void add_method_floor(std::span<const LogSurvey> logs, const IdentifyOptions& options,
                      const JointFit& fit, const JudgedPoint& judged,
                      std::vector<PreloadFacts>& facts, std::vector<Estimate>& estimates);

}  // namespace cablefit
