#include "cablefit/identify/elongations/judged_point.hpp"

#include "cablefit/identify/elongations/elongation_descent.hpp"

namespace cablefit {
namespace {

/// Elongations linearised about the point, and all inequalities.
std::vector<ProfileInterval> profiles_of(const JointFit& fit, const JointPoint& point) {
  JointProblem problem =
      joint_problem(fit.jobs, fit.layout, point.input(), fit.weights, {true, point.solution.x});
  const Eigen::MatrixXd rows = physical_bounds(fit, point.l_o).rows;
  problem.inequalities = Eigen::MatrixXd::Zero(rows.rows(), problem.n_params());
  problem.inequalities.leftCols(rows.cols()) = rows;
  std::vector<ProfileInterval> all = joint_profiles(problem);
  all.resize(static_cast<std::size_t>(fit.layout.n_linear));
  return all;
}

}  // namespace

JudgedPoint judge_point(const JointFit& fit, JointPoint point) {
  JudgedPoint judged{std::move(point), {}, {}, {}, {}, {}};
  judged.point.solution = solve_bounded(fit, judged.point);
  judged.problem = linearised(fit, judged.point);
  judged.linearised = solve(judged.problem);
  judged.covariance = joint_covariance(judged.problem, judged.linearised);
  if (judged.point.solution.active.empty()) return judged;
  const JointProblem free =
      joint_problem(fit.jobs, fit.layout, judged.point.input(), fit.weights, {});
  const JointSolution s = solve(free);
  judged.unbounded = UnboundedFit{s.x, joint_covariance(free, s)};
  judged.profile = profiles_of(fit, judged.point);
  return judged;
}

}  // namespace cablefit
