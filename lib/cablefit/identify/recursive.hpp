// Recursive least squares (R-LSA, [43] of Fichera & Grossard 2017) in square-root information form
// (Bierman 1977, ch. V): rows are taken in one after the other by QR, and what has been seen so far
// is solved with the equalities of the direct fit (D-LSA), whose answer is reached at the end.
#pragma once

#include "cablefit/identify/identify_result.hpp"
#include "cablefit/identify/joint_fit.hpp"

namespace cablefit {

/// The linear parameters on the way, at the l_o and with the weights of `point`; about `n_points`
/// per preload and kind of log. `sd`: of the direct fit, honest and with l_o uncertain, where the
/// band ends; on the way it has the same ratio to that of the rows seen so far. One pass over the
/// logs.
RecursiveTrace recursive_trace(const JointFit& fit, const JointPoint& point,
                               const Eigen::VectorXd& sd, int n_points = 100);

/// A figure per parameter: the estimate with its band of +-2 sd, and where it ends.
std::vector<Figure> trace_figures(const RecursiveTrace& trace);

/// rows,record,NAME,sd NAME,...; empty cells where nothing is known yet.
std::string trace_csv(const RecursiveTrace& trace);

}  // namespace cablefit
