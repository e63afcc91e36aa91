#include "cablefit/dynamic/rows/settled_effects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace cablefit {
namespace {

constexpr int kMostPasses = 12;
constexpr double kStill = 0.1;      // sd
constexpr double kMostShare = 0.5;  // of a value, that one step may move it by

bool is_nonlinear(const DynamicParameter& parameter) { return parameter.origin != 0; }

bool has_nonlinear(const std::vector<EquationRows>& equations) {
  return std::any_of(equations.begin(), equations.end(), [](const EquationRows& e) {
    return std::any_of(e.columns.parameters.begin(), e.columns.parameters.end(), is_nonlinear);
  });
}

/// Moves the effects of one equation to its solution. The parameter that moved most; empty: none
/// did by more than kStill.
std::string move_effects(const DynamicColumns& columns, LinearSolution s,
                         std::vector<RefinementInstance>& added) {
  std::string moved;
  double furthest = kStill;
  for (std::size_t k = 0; k < columns.parameters.size(); ++k) {
    const DynamicParameter& p = columns.parameters[k];
    double& step = s.x(static_cast<Eigen::Index>(k));
    if (!is_nonlinear(p)) continue;
    if (!s.not_identifiable[k].empty() || !std::isfinite(step)) {
      step = 0;
      continue;
    }
    const double sd =
        std::sqrt(s.covariance(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(k)));
    if (std::abs(step) > furthest * sd) {
      furthest = std::abs(step) / sd;
      moved = p.name;
    }
    step = std::clamp(step, -kMostShare * std::abs(p.origin), kMostShare * std::abs(p.origin));
  }
  take_values(columns, s.x, added);
  return moved;
}

}  // namespace

WindowCounts collect_settled(DynamicJob& job, std::vector<EquationRows>& equations,
                             std::string& warning) {
  for (int pass = 1;; ++pass) {
    equations = make_equations(job);
    const WindowCounts windows = collect_rows(job, equations);
    if (!has_nonlinear(equations)) return windows;
    std::vector<RefinementInstance> added = job.added;
    std::string moving;
    for (const EquationRows& e : equations)
      if (const std::string moved =
              move_effects(e.columns, solve_equation(e, job.elastic, 0), added);
          !moved.empty())
        moving = moved;
    if (moving.empty()) return windows;
    if (pass == kMostPasses) {
      warning = fmt::format("{} did not converge in {} iterations: the logs hardly determine it",
                            moving, kMostPasses);
      return windows;
    }
    job.added = std::move(added);
  }
}

}  // namespace cablefit
