// Whether the fit explains the logs at all: what contradicts the rig file says so here rather than
// by numbers with small sd.
#pragma once

#include <string>
#include <vector>

#include "cablefit/identify/elongations/judged_point.hpp"
#include "cablefit/identify/identify_result.hpp"

namespace cablefit {

/// Throws Error(not_identifiable) where an equation of a preload leaves as much as it has: the rig
/// file is not that of the logs. `job`: the preload's place.
void require_explained(const JointFit& fit, const JudgedPoint& judged, std::size_t job);

/// Warnings of equations that leave more than friction and noise do, of a line that is not the
/// measured one, and of what looks like a preload.
std::vector<std::string> misfit_warnings(const JointFit& fit, const JudgedPoint& judged,
                                         std::size_t job, const IdentifyPreload& preload);

}  // namespace cablefit
