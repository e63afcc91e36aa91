// Profile likelihood of the motor radii (Raue et al. 2009): the likelihood of one radius, and of
// those on the same motor with it, when everything else may follow.
#pragma once

#include <span>
#include <vector>

#include "cablefit/base/parameter.hpp"
#include "cablefit/identify/elongations/judged_point.hpp"

namespace cablefit {

/// Takes the 95 % intervals of the searched radii from their profiles; `estimates`: one per
/// parameter of the layout. A radius whose profile is flat on both sides is not identifiable.
/// Weights stay as they are, and the deviance has the curvature of the robust variance (Kent 1982).
void profile_radii(const JointFit& fit, const JudgedPoint& judged, std::span<Estimate> estimates);

}  // namespace cablefit
