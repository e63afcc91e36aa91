// What the fit says of each parameter: a number with its sd and interval, a bound that holds it, or
// why there is none. Result files, traces and models all read it from here.
#pragma once

#include "cablefit/identify/elongations/elongation_profile.hpp"
#include "cablefit/identify/elongations/judged_point.hpp"

namespace cablefit {

/// Every parameter of the layout, in its order; intervals of l_o are those of the profiles.
std::vector<Estimate> joint_estimates(const JointFit& fit, const JudgedPoint& judged,
                                      const std::vector<ElongationProfile>& profiles, bool robust);

}  // namespace cablefit
