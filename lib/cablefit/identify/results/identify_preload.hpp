// What is found of one preload besides its parameters.
#pragma once

#include "cablefit/identify/elongations/judged_point.hpp"
#include "cablefit/identify/equations/preload_jobs.hpp"
#include "cablefit/identify/identify_result.hpp"

namespace cablefit {

/// Cables, ranges, equilibrium, K line and equations of the preload; `job`: its place.
IdentifyPreload preload_of(const JointFit& fit, const JudgedPoint& judged, std::size_t job,
                           const PreloadFacts& facts);

}  // namespace cablefit
