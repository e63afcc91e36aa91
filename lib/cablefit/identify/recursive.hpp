// Recursive least squares (R-LSA, recursive_trace.hpp) of the one-step identification.
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

}  // namespace cablefit
