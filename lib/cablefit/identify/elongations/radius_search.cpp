#include "cablefit/identify/elongations/radius_search.hpp"

#include <algorithm>
#include <cmath>

#include "cablefit/identify/elongations/descent_limits.hpp"
#include "cablefit/identify/equations/joint_radii.hpp"

namespace cablefit {
namespace {

constexpr double kLargestChange = 0.1;  // of a radius

/// What Gauss-Newton changes: ln r_m of every searched radius, and l_o.
struct RadiusStep {
  Eigen::VectorXd ln_radius;
  Eigen::VectorXd l_o;  ///< of all that are searched

  double largest() const { return ln_radius.cwiseAbs().maxCoeff(); }
};

RadiusStep step_from(const JointFit& fit, const JointPoint& point,
                     const std::vector<Eigen::Index>& held) {
  JointProblem problem = next_step(fit, point);
  JointSolution s = solve(problem);
  const Eigen::VectorXd radius = searched_radii(fit);
  const Eigen::Index first = fit.layout.first_radius();
  Eigen::Index n_held = 0;
  for (Eigen::Index k = 0; k < radius.size(); ++k) {
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(problem.n_params(), first + k);
    const double sd = std::sqrt(std::max(0.0, s.solve_operator(first + k, first + k)));
    const bool is_held = std::find(held.begin(), held.end(), k) != held.end();
    if (!is_held && s.determines(unit) && sd < kOpenRadius * std::abs(radius(k))) continue;
    problem.equalities.conservativeResize(problem.equalities.rows() + 1, problem.n_params());
    problem.equalities.bottomRows(1) = unit.transpose();
    ++n_held;
  }
  if (n_held == radius.size()) return {Eigen::VectorXd::Zero(radius.size()), {}};
  if (n_held > 0) s = solve(problem);
  return {s.x.tail(radius.size()).cwiseQuotient(radius),
          s.x.segment(fit.layout.n_linear, fit.layout.n_elongations)};
}

/// A descent of the elongations at radii along the step.
JointPoint point_at(JointFit& fit, const JointPoint& from, const RadiusStep& step, double length) {
  Elongations l_o = from.l_o;
  for (Eigen::Index k = 0; k < step.l_o.size(); ++k) {
    const JointParameter& p =
        fit.layout.parameters[static_cast<std::size_t>(fit.layout.n_linear + k)];
    l_o[static_cast<std::size_t>(p.preload)](static_cast<Eigen::Index>(p.cable)) +=
        length * step.l_o(k);
  }
  return descend(fit, {{std::move(l_o)}}).front();
}

/// Moves fit and point to the first better place on the way; false: there is none.
bool advance(JointFit& fit, JointPoint& point, const RadiusStep& step) {
  double length = std::min(1.0, kLargestChange / step.largest());
  while (length > kSmallestDescent) {
    JointFit next =
        with_radii(fit, searched_radii(fit).array() * (length * step.ln_radius.array()).exp());
    JointPoint at = point_at(next, point, step, length);
    if (at.merit() < point.merit()) {
      fit = std::move(next);
      point = std::move(at);
      return true;
    }
    length /= 4;
  }
  return false;
}

}  // namespace

JointPoint search_radii(JointFit& fit, JointPoint point, const std::vector<Eigen::Index>& held) {
  const Eigen::Index n_radii =
      static_cast<Eigen::Index>(fit.layout.parameters.size()) - fit.layout.first_radius();
  if (static_cast<Eigen::Index>(held.size()) == n_radii) return point;
  for (int iteration = 0; iteration < kMostDescents; ++iteration) {
    const RadiusStep step = step_from(fit, point, held);
    if (!(step.largest() > kDescentConverged) || !advance(fit, point, step)) break;
  }
  return point;
}

}  // namespace cablefit
