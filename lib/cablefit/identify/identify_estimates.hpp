// From the joint solution to what reports show.
#pragma once

#include "cablefit/identify/elongation_search.hpp"
#include "cablefit/identify/identify.hpp"
#include "cablefit/identify/preload_jobs.hpp"

namespace cablefit {

/// The solution with everything that judges it.
struct JudgedPoint {
  JointPoint point;             ///< rows with cells
  JointProblem problem;         ///< all parameters, l_o linearised
  JointSolution linearised;     ///< of that problem
  JointCovariance covariance;   ///< of all parameters
  Eigen::VectorXd unbounded_x;  ///< linear parameters without inequalities; empty: none is active
  Eigen::VectorXd unbounded_sd;
};

/// Problem, solution and covariance at the point (evaluated with cells).
JudgedPoint judge_point(const JointFit& fit, JointPoint point);

/// Every parameter of the layout, in its order.
std::vector<Estimate> joint_estimates(const JointFit& fit, const JudgedPoint& judged, bool honest);

/// Fills parameters, preloads, equations, K lines, slack points and models of the result.
void describe(const JointFit& fit, const JudgedPoint& judged,
              const std::vector<PreloadFacts>& facts, const IdentifyOptions& options,
              IdentifyResult& result);

}  // namespace cablefit
