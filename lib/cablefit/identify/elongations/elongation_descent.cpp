#include "cablefit/identify/elongations/elongation_descent.hpp"

#include <algorithm>
#include <cmath>

#include "cablefit/identify/elongations/descent_limits.hpp"
#include "cablefit/identify/equations/admissible_elongations.hpp"
#include "cablefit/identify/equations/equilibrium.hpp"

namespace cablefit {
namespace {

constexpr double kLargestStep = 0.2;    // of the reach
constexpr double kNearEquilibrium = 2;  // merit with equilibrium over that without
constexpr double kNearSlack = 0.01;     // of the reach: the other side of l_o = 0 is worth a look

bool is_held(const std::vector<Eigen::Index>& held, Eigen::Index k) {
  return std::find(held.begin(), held.end(), k) != held.end();
}

/// Which elongations of a job may move.
std::vector<bool> movable(const JointFit& fit, std::size_t job,
                          const std::vector<Eigen::Index>& held) {
  std::vector<bool> moves = fit.jobs[job].searched;
  for (std::size_t c = 0; c < moves.size(); ++c) {
    const Eigen::Index k = fit.layout.find(elongation_name(fit.jobs[job].transmission.cables[c]),
                                           static_cast<int>(job));
    moves[c] = moves[c] && !is_held(held, k);
  }
  return moves;
}

/// Coefficients about which to linearise. Far from equilibrium, those constrained to it are no
/// guide, so unconstrained ones are used.
struct Pivot {
  Eigen::VectorXd x;
  bool near = false;
};

Pivot pivot_of(const JointFit& fit, const JointPoint& point) {
  const JointSolution loose =
      solve(joint_problem(fit.jobs, fit.layout, point.input(), fit.weights, {false, {}}));
  const bool near = point.merit() < kNearEquilibrium * loose.weighted_rss;
  return {near ? point.solution.x : loose.x, near};
}

void append_row(Eigen::MatrixXd& rows, const Eigen::RowVectorXd& row) {
  rows.conservativeResize(rows.rows() + 1, row.size());
  rows.row(rows.rows() - 1) = row;
}

/// The places, and those of every r_m: a descent moves the elongations alone.
std::vector<Eigen::Index> and_radii(const JointFit& fit, std::vector<Eigen::Index> held) {
  const auto n = static_cast<Eigen::Index>(fit.layout.parameters.size());
  for (Eigen::Index k = fit.layout.first_radius(); k < n; ++k) held.push_back(k);
  return held;
}

/// All parameters, l_o and r_m as their changes.
JointProblem about(const JointFit& fit, const JointPoint& point, const Pivot& pivot,
                   const std::vector<Eigen::Index>& held) {
  JointProblem problem = joint_problem(fit.jobs, fit.layout, point.input(), fit.weights,
                                       {true, pivot.x.head(fit.layout.n_coefficients)});
  for (const Eigen::Index k : held)
    append_row(problem.equalities, Eigen::RowVectorXd::Unit(problem.n_params(), k));
  if (pivot.near && !point.solution.active.empty()) {
    const Eigen::MatrixXd bounds = physical_bounds(fit, point.l_o).rows;
    for (const Eigen::Index i : point.solution.active) {
      Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(problem.n_params());
      row.head(fit.layout.n_linear) = bounds.row(i);
      append_row(problem.equalities, row);
    }
  }
  return problem;
}

/// One descent on its way.
struct Descent {
  JointPoint point;
  std::vector<Eigen::Index> held;
  Eigen::VectorXd step;  ///< of all searched l_o, Gauss-Newton
  Eigen::VectorXd x;     ///< coefficients that go with it
  double length = 1;     ///< of the step
  bool done = false;
};

double& elongation_at(const JointFit& fit, Elongations& l_o, Eigen::Index searched) {
  const JointParameter& p =
      fit.layout.parameters[static_cast<std::size_t>(fit.layout.n_linear + searched)];
  return l_o[static_cast<std::size_t>(p.preload)](static_cast<Eigen::Index>(p.cable));
}

/// Elongations at 0 that the step would stretch where no other cable could balance them.
std::vector<Eigen::Index> blocked_by_slack(const JointFit& fit, const JointPoint& point,
                                           const Eigen::VectorXd& step) {
  Elongations target = point.l_o;
  for (Eigen::Index k = 0; k < step.size(); ++k) elongation_at(fit, target, k) += step(k);
  std::vector<Eigen::Index> blocked;
  for (Eigen::Index k = 0; k < step.size(); ++k) {
    const JointParameter& p =
        fit.layout.parameters[static_cast<std::size_t>(fit.layout.n_linear + k)];
    const auto job = static_cast<std::size_t>(p.preload);
    const double now = point.l_o[job](static_cast<Eigen::Index>(p.cable));
    if (now == 0 && step(k) > 0 && !can_balance(fit.jobs[job].transmission, target[job]))
      blocked.push_back(fit.layout.n_linear + k);
  }
  return blocked;
}

void look_ahead(const JointFit& fit, Descent& descent) {
  const Pivot pivot = pivot_of(fit, descent.point);
  JointSolution s = solve(about(fit, descent.point, pivot, descent.held));
  const auto step_of = [&](const JointSolution& solution) -> Eigen::VectorXd {
    return solution.x.segment(fit.layout.n_linear, fit.layout.n_elongations);
  };
  std::vector<Eigen::Index> held = blocked_by_slack(fit, descent.point, step_of(s));
  if (!held.empty()) {
    held.insert(held.end(), descent.held.begin(), descent.held.end());
    s = solve(about(fit, descent.point, pivot, held));
  }
  descent.step = step_of(s);
  descent.x = s.x.head(fit.layout.n_linear);
  descent.length = 1;
  double relative = 0;
  for (Eigen::Index k = 0; k < descent.step.size(); ++k) {
    const JointParameter& p =
        fit.layout.parameters[static_cast<std::size_t>(fit.layout.n_linear + k)];
    const double reach = search_reach(fit, static_cast<std::size_t>(p.preload), p.cable);
    relative = std::max(relative, std::abs(descent.step(k)) / reach);
  }
  if (relative > kLargestStep) descent.length = kLargestStep / relative;
  descent.done = !(relative > kDescentConverged);
}

Elongations moved(const JointFit& fit, const Descent& descent) {
  Elongations l_o = descent.point.l_o;
  for (Eigen::Index k = 0; k < descent.step.size(); ++k) {
    const JointParameter& p =
        fit.layout.parameters[static_cast<std::size_t>(fit.layout.n_linear + k)];
    const auto job = static_cast<std::size_t>(p.preload);
    double& l = l_o[job](static_cast<Eigen::Index>(p.cable));
    const double reach = search_reach(fit, job, p.cable);
    if (!is_held(descent.held, fit.layout.n_linear + k))
      l = std::clamp(l + descent.length * descent.step(k), -reach, reach);
  }
  for (std::size_t j = 0; j < l_o.size(); ++j) {
    const std::vector<bool> moves = movable(fit, j, descent.held);
    make_admissible(fit.jobs[j], moves, l_o[j]);
    if (descent.length == 1) restore_equilibrium(fit.jobs[j], moves, descent.x, l_o[j]);
  }
  return l_o;
}

/// Takes the next point when it is better, else shortens the step.
void judge(const JointFit& fit, JointPoint&& next, Descent& descent) {
  if (next.merit() < descent.point.merit()) {
    descent.point = std::move(next);
    look_ahead(fit, descent);
    return;
  }
  descent.length /= 4;
  descent.done = descent.length < kSmallestDescent;
}

}  // namespace

const JointPoint& best_of(const std::vector<JointPoint>& points) {
  return *std::min_element(
      points.begin(), points.end(),
      [](const JointPoint& a, const JointPoint& b) { return a.merit() < b.merit(); });
}

JointProblem linearised(const JointFit& fit, const JointPoint& point) {
  return about(fit, point, {point.solution.x, true}, {});
}

JointProblem next_step(const JointFit& fit, const JointPoint& point) {
  return about(fit, point, pivot_of(fit, point), {});
}

Eigen::Index n_undetermined(const JointFit& fit, const JointPoint& point) {
  return solve(linearised(fit, point)).null_directions.cols();
}

double search_reach(const JointFit& fit, std::size_t job, std::size_t cable) {
  return 2 * fit.displacements(job, cable).reach();
}

std::vector<JointPoint> descend(JointFit& fit, const std::vector<ElongationStart>& starts) {
  std::vector<Descent> descents;
  std::vector<Elongations> first;
  for (const ElongationStart& start : starts) {
    first.push_back(start.l_o);
    for (std::size_t j = 0; j < fit.jobs.size(); ++j)
      make_admissible(fit.jobs[j], movable(fit, j, start.held), first.back()[j]);
  }
  std::vector<JointPoint> points = evaluate(fit, first);
  for (std::size_t d = 0; d < starts.size(); ++d) {
    descents.push_back({std::move(points[d]), and_radii(fit, starts[d].held), {}, {}});
    look_ahead(fit, descents.back());
  }
  for (int iteration = 0; iteration < kMostDescents; ++iteration) {
    std::vector<Elongations> next;
    for (const Descent& descent : descents)
      if (!descent.done) next.push_back(moved(fit, descent));
    if (next.empty()) break;
    points = evaluate(fit, next);
    std::size_t p = 0;
    for (Descent& descent : descents)
      if (!descent.done) judge(fit, std::move(points[p++]), descent);
  }
  points.clear();
  for (Descent& descent : descents) points.push_back(std::move(descent.point));
  return points;
}

JointPoint polish(JointFit& fit, const JointPoint& point) {
  std::vector<ElongationStart> starts = {{point.l_o}};
  for (std::size_t j = 0; j < fit.jobs.size(); ++j)
    for (const std::vector<std::size_t>& group : cable_groups(fit.jobs[j].transmission)) {
      double nearest = kUnbounded, reach = 0;
      for (const std::size_t c : group) {
        if (!fit.jobs[j].searched[c]) continue;
        nearest = std::min(nearest, std::abs(point.l_o[j](static_cast<Eigen::Index>(c))));
        reach = std::max(reach, search_reach(fit, j, c));
      }
      if (!(nearest < kNearSlack * reach)) continue;
      for (const double to : {0.0, -0.1 * kNearSlack}) {
        starts.push_back({point.l_o});
        for (const std::size_t c : group)
          if (fit.jobs[j].searched[c])
            starts.back().l_o[j](static_cast<Eigen::Index>(c)) = to * search_reach(fit, j, c);
      }
    }
  return best_of(descend(fit, starts));
}

}  // namespace cablefit
