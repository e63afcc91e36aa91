// What is found of one preload besides its parameters.
#pragma once

#include "cablefit/identify/identify_result.hpp"
#include "cablefit/identify/judged_point.hpp"
#include "cablefit/identify/preload_jobs.hpp"

namespace cablefit {

/// Cables, ranges, equilibrium, K line and equations of the preload; `job`: its place.
IdentifyPreload preload_of(const JointFit& fit, const JudgedPoint& judged, std::size_t job,
                           const PreloadFacts& facts);

}  // namespace cablefit
