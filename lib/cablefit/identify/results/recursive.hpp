// Recursive least squares (R-LSA, recursive_trace.hpp) of the one-step identification.
#pragma once

#include "cablefit/identify/equations/joint_fit.hpp"
#include "cablefit/identify/identify_result.hpp"

namespace cablefit {

/// The linear parameters on the way, at the l_o and with the weights of `point`; about `n_points`
/// per preload and kind of log. `estimates`: of the direct fit, per parameter of the layout. The
/// band ends at their sd (with l_o uncertain) and on the way has the same ratio to that of the rows
/// seen so far; a parameter that a bound holds has none, and one that is not identifiable stays
/// empty. One pass over the logs.
RecursiveTrace recursive_trace(const JointFit& fit, const JointPoint& point,
                               const std::vector<Estimate>& estimates, int n_points = 100);

}  // namespace cablefit
