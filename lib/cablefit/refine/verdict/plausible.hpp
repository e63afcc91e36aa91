// Can the fitted effect be the law of its row? A flexible law fits much; with extreme parameters it
// approximates another law. Internal to refine/.
#pragma once

#include <string>

#include "cablefit/refine/rows/design.hpp"

namespace cablefit {

/// Judges the last of design.added, whose linear parameters are the last entries of `x`. Reasons
/// against it: a nonlinear parameter at the end of its range beyond which the law is another one
/// (ShapeGrid), parts that cancel each other, or a step of the deflection that the logs would show.
/// Empty: there is no reason against it.
std::string why_not_plausible(const Design& design, const Eigen::VectorXd& x);

}  // namespace cablefit
