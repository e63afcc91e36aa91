#include "cablefit/identify/judged_point.hpp"

#include "cablefit/identify/elongation_descent.hpp"

namespace cablefit {

JudgedPoint judge_point(const JointFit& fit, JointPoint point) {
  JudgedPoint judged{std::move(point), {}, {}, {}, {}};
  judged.point.solution = solve_bounded(fit, judged.point);
  judged.problem = linearised(fit, judged.point);
  judged.linearised = solve(judged.problem);
  judged.covariance = joint_covariance(judged.problem, judged.linearised);
  if (judged.point.solution.active.empty()) return judged;
  const JointProblem free =
      joint_problem(fit.jobs, fit.layout, judged.point.input(), fit.weights, {});
  const JointSolution s = solve(free);
  judged.unbounded = UnboundedFit{s.x, joint_covariance(free, s)};
  return judged;
}

}  // namespace cablefit
