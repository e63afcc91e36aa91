#include "cablefit/dynamic/cutoff_check.hpp"

#include <fmt/format.h>

#include <cmath>

#include "cablefit/dynamic/estimates.hpp"
#include "cablefit/dynamic/scaled_settings.hpp"
#include "cablefit/estimate/long_run.hpp"
#include "cablefit/samples/agreement.hpp"

namespace cablefit {
namespace {

constexpr double kOtherCutoffs[] = {0.5, 2};

Estimate* inertia_of(const EquationRows& e, std::size_t parameter, DynamicFit& fit) {
  const DynamicParameter& wanted = e.columns.parameters[parameter];
  if (!wanted.is_inertia || wanted.given) return nullptr;
  for (Estimate& found : fit.parameters)
    if (found.name == wanted.name && found.not_identifiable.empty() && found.sd > 0) return &found;
  return nullptr;
}

/// What the fit with the other cut-off says against it; empty: nothing.
std::string objection(const Estimate& e, const LinearSolution& other, std::size_t parameter,
                      double cutoff, double factor) {
  const auto k = static_cast<Eigen::Index>(parameter);
  if (!other.not_identifiable[parameter].empty()) return "";
  const double half = t_quantile_975(other.degrees_of_freedom) * std::sqrt(other.covariance(k, k));
  const bool meet =
      other.unbounded_x(k) - half <= e.ci_high && other.unbounded_x(k) + half >= e.ci_low;
  const double moved = std::abs(other.unbounded_x(k) - e.value);
  if (meet || moved <= kMovedInertia * std::abs(e.value)) return "";
  return fmt::format(
      "{:.3g} at a cut-off of {:.3g} Hz is {:.3g} at {:.3g} Hz, more than the interval allows: the "
      "logs do not determine it; accelerate more",
      e.value, cutoff, other.unbounded_x(k), factor * cutoff);
}

void check_at(double factor, const EstimationTask& task, Estimation& estimation) {
  const double cutoff = task.job.settings.rows.signal.cutoff;
  const DynamicJob other = with_cutoff_scaled(task.job, factor);
  std::vector<EquationRows> equations = make_equations(other);
  collect_rows(other, equations);
  for (std::size_t k = 0; k < equations.size(); ++k) {
    if (equations[k].rows->n_rows() < 4 * equations[k].columns.count) continue;
    const LinearSolution solution = solve_equation(equations[k], other.elastic, task.model);
    for (std::size_t p = 0; p < equations[k].columns.parameters.size(); ++p) {
      Estimate* const e = inertia_of(equations[k], p, estimation.fit);
      const std::string text = e == nullptr ? "" : objection(*e, solution, p, cutoff, factor);
      if (text.empty()) continue;
      refuse(*e, text);
      estimation.fit.verdicts[e->name] = "not identifiable";
    }
  }
}

}  // namespace

void refuse_moving_inertias(const EstimationTask& task, Estimation& estimation) {
  const double cutoff = task.job.settings.rows.signal.cutoff;
  if (!(cutoff > 0) || systems_of(task.equations).size() < task.equations.size()) return;
  const double rate = sample_rates(task.job.logs, task.job.wanted).lowest;
  for (const double factor : kOtherCutoffs)
    if (factor * cutoff <= kMostShareOfRate * rate) check_at(factor, task, estimation);
}

}  // namespace cablefit
