// Motor radii by Gauss-Newton: at each choice of them the elongations follow by a descent of their
// own, so that one rig of known radii is fitted at a time.
#pragma once

#include "cablefit/identify/elongations/elongation_descent.hpp"

namespace cablefit {

/// The point of the best radii near those of the fit's jobs, which are moved there; the point as it
/// is when no radius is searched. A radius that the data do not determine stays, and so do those of
/// `held`, places among the radii.
JointPoint search_radii(JointFit& fit, JointPoint point,
                        const std::vector<Eigen::Index>& held = {});

/// Relative sd from which on a radius counts as not determined: the column of such a radius is that
/// of other parameters but for noise.
inline constexpr double kOpenRadius = 0.3;

}  // namespace cablefit
