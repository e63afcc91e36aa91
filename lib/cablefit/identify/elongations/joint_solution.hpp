// The best point of the whole problem: weights, l_o, r_m and everything that judges them.
#pragma once

#include <vector>

#include "cablefit/identify/elongations/elongation_profile.hpp"
#include "cablefit/identify/elongations/judged_point.hpp"
#include "cablefit/identify/identify_result.hpp"

namespace cablefit {

/// Weights by the residuals at the point and the point by the weights, until both stand.
JointPoint settle(JointFit& fit, JointPoint point);

/// The best point of the full problem, from where that of the elastic side alone ended if that is
/// a place.
JointPoint fit_all(JointFit& fit, const JointFit& first, const JointPoint& start);

/// Shares the inertias, of which each preload has its own, where the preloads agree: one drive has
/// one set of them. Tells what was decided.
JointPoint share_inertias(JointFit& fit, JointPoint point, IdentifyResult& result);

struct Profiled {
  JudgedPoint judged;
  std::vector<ElongationProfile> profiles;
};
/// The point judged; a profile that leads below it says where to search on. Throws
/// Error(not_identifiable) when that finds no end.
Profiled judge_with_profiles(JointFit& fit, JointPoint point);

}  // namespace cablefit
