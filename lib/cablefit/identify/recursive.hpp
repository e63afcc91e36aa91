// Recursive least squares (R-LSA, [43] of Fichera & Grossard 2017) in square-root information form
// (Bierman 1977, ch. V): rows are taken in one after the other by QR, and what has been seen so far
// is solved with the equalities of the direct fit (D-LSA), whose answer is reached at the end.
#pragma once

#include "cablefit/identify/identify_result.hpp"
#include "cablefit/identify/joint_fit.hpp"

namespace cablefit {

/// The linear parameters on the way, at the l_o and with the weights of `point`; about `n_points`
/// per preload and kind of log. `estimates`: of the direct fit, per parameter of the layout. The
/// band ends at their sd (with l_o uncertain) and on the way has the same ratio to that of the rows
/// seen so far; a parameter that a bound holds has none, and one that is not identifiable stays
/// empty. One pass over the logs.
RecursiveTrace recursive_trace(const JointFit& fit, const JointPoint& point,
                               const std::vector<Estimate>& estimates, int n_points = 100);

/// A figure per parameter: the estimate with its band of +-2 sd, and where it ends.
std::vector<Figure> trace_figures(const RecursiveTrace& trace);

}  // namespace cablefit
