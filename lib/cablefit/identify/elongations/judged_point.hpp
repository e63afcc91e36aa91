// The joint solution with everything that judges it.
#pragma once

#include <optional>

#include "cablefit/identify/equations/joint_fit.hpp"

namespace cablefit {

/// The fit to the same rows without inequalities, for the interval at a bound.
struct UnboundedFit {
  Eigen::VectorXd x;           ///< linear parameters
  JointCovariance covariance;  ///< of them
};

struct JudgedPoint {
  JointPoint point;                       ///< rows with cells
  JointProblem problem;                   ///< all parameters, l_o linearised
  JointSolution linearised;               ///< of that problem
  JointCovariance covariance;             ///< of all parameters
  std::optional<UnboundedFit> unbounded;  ///< where inequalities hold the solution
  std::vector<ProfileInterval> profile;   ///< of all linear parameters, where they do
};

/// Problem, solution and covariance at the point (evaluated with cells).
JudgedPoint judge_point(const JointFit& fit, JointPoint point);

}  // namespace cablefit
