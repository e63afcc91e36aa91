#include "cablefit/dynamic/rows/settled_effects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace cablefit {
namespace {

constexpr int kMostPasses = 12;
constexpr double kSmallestMoveSd = 0.1;  // sd

bool has_nonlinear(const std::vector<EquationRows>& equations) {
  return std::any_of(equations.begin(), equations.end(), [](const EquationRows& e) {
    return std::any_of(e.columns.parameters.begin(), e.columns.parameters.end(),
                       [](const DynamicParameter& p) { return p.is_nonlinear; });
  });
}

/// Moves the effects of one equation to its solution; what that does not determine stays. The
/// parameter that moved most; empty: none did by more than kSmallestMoveSd.
std::string move_effects(const DynamicColumns& columns, LinearSolution s, EffectsPerJoint& added) {
  std::string moved;
  double furthest = kSmallestMoveSd;
  for (std::size_t k = 0; k < columns.parameters.size(); ++k) {
    const DynamicParameter& p = columns.parameters[k];
    const auto at = static_cast<Eigen::Index>(k);
    if (!s.not_identifiable[k].empty()) s.x(at) = std::numeric_limits<double>::quiet_NaN();
    if (!p.is_nonlinear || !std::isfinite(s.x(at))) continue;
    s.x(at) = p.moved(s.x(at)) - p.origin;
    const double sd = std::sqrt(s.covariance(at, at));
    if (std::abs(s.x(at)) <= furthest * sd) continue;
    furthest = std::abs(s.x(at)) / sd;
    moved = p.name;
  }
  take_values(columns, s.x, added);
  return moved;
}

}  // namespace

WindowCounts collect_settled(DynamicJob& job, std::vector<EquationRows>& equations,
                             std::string& warning) {
  for (int pass = 1;; ++pass) {
    equations = make_equations(job);
    const WindowCounts windows = collect_rows(job, equations, Peaks::kept);
    if (!has_nonlinear(equations)) return windows;
    EffectsPerJoint added = job.added;
    std::string moving;
    const std::vector<LinearSolution> solutions = solve_equations(equations, job.elastic, 0);
    for (std::size_t k = 0; k < equations.size(); ++k)
      if (const std::string moved = move_effects(equations[k].columns, solutions[k], added);
          !moved.empty())
        moving = moved;
    if (moving.empty()) return windows;
    if (pass == kMostPasses) {
      warning =
          fmt::format("{} did not converge in {} iterations: the logs do not determine it well",
                      moving, kMostPasses);
      return windows;
    }
    job.added = std::move(added);
  }
}

}  // namespace cablefit
