// l_o by variable projection (Golub & Pereyra 1973; Kaufman 1975): the way down from one start.
#pragma once

#include <vector>

#include "cablefit/identify/equations/joint_fit.hpp"

namespace cablefit {

/// Where a descent starts.
struct ElongationStart {
  Elongations l_o;  ///< those that are not searched as known
  /// Places among the layout's parameters, all of l_o, that stand still as well.
  std::vector<Eigen::Index> held = {};
};

/// The points that Gauss-Newton with step halving reaches; all descents share their passes over the
/// logs. Motor radii that are searched stand still. Deterministic.
std::vector<JointPoint> descend(JointFit& fit, const std::vector<ElongationStart>& starts);

/// The problem of all parameters about a point, l_o and r_m as their changes; what holds the
/// point's solution (equilibrium, active bounds) as equalities.
JointProblem linearised(const JointFit& fit, const JointPoint& point);

/// The same for a step of all of l_o and r_m: far from equilibrium about coefficients without it.
JointProblem next_step(const JointFit& fit, const JointPoint& point);

/// Directions of all parameters, l_o and r_m included, that the data do not determine there.
Eigen::Index n_undetermined(const JointFit& fit, const JointPoint& point);

/// Largest |l_o| looked at: twice the way that the logs stretch or slacken the cable.
double search_reach(const JointFit& fit, std::size_t job, std::size_t cable);

/// Descends from the point, and where a preload is next to none also from either side of l_o = 0:
/// equilibrium ties the elongations on one side only.
JointPoint polish(JointFit& fit, const JointPoint& point);

/// The one of least merit.
const JointPoint& best_of(const std::vector<JointPoint>& points);

}  // namespace cablefit
