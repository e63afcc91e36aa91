// Whether what was fitted can be the law that the row names. A flexible law fits much; where it
// does so by an extreme of its parameters, it stands for something else. Internal to refine/.
#pragma once

#include <string>

#include "cablefit/refine/rows/design.hpp"

namespace cablefit {

/// Of the last of design.added, whose linear parameters are the last entries of `x`: a nonlinear
/// parameter at the end of its range beyond which the law is another one (ShapeGrid), parts that
/// cancel each other, or a step of the deflection that the logs cannot have missed. Empty: nothing
/// speaks against it.
std::string why_not_plausible(const Design& design, const Eigen::VectorXd& x);

}  // namespace cablefit
