#include "cablefit/dynamic/checks/cutoff_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/dynamic/estimates/estimates.hpp"
#include "cablefit/dynamic/loops/log_copy.hpp"
#include "cablefit/dynamic/rows/scaled_settings.hpp"
#include "cablefit/estimate/fit/parameter_estimate.hpp"
#include "cablefit/estimate/spread/long_run.hpp"
#include "cablefit/samples/rows/agreement.hpp"
#include "cablefit/samples/survey/noise.hpp"

namespace cablefit {
namespace {

constexpr double kOtherCutoffs[] = {0.5, 2};
// Of longer logs so many rows, in evenly spaced stretches: what counts is a movement of
// kMovementNoted, beside which the scatter of a fit to them is small.
constexpr double kRowsForCheck = 250000;
constexpr double kNoisyShare = 0.05;  // noise in a regressor shrinks its coefficient by that share

Estimate* inertia_of(const EquationRows& e, std::size_t parameter, DynamicFit& fit) {
  const DynamicParameter& wanted = e.columns.parameters[parameter];
  if (!wanted.is_inertia || wanted.given) return nullptr;
  for (Estimate& found : fit.parameters)
    if (found.name == wanted.name && found.not_identifiable.empty() && found.sd > 0) return &found;
  return nullptr;
}

/// The value at the other cut-off where its interval does not meet the estimate's; else the
/// estimate.
double value_there(const Estimate& e, const LinearSolution& other, std::size_t parameter) {
  const auto k = static_cast<Eigen::Index>(parameter);
  if (!other.not_identifiable[parameter].empty()) return e.value;
  const double value = other.unbounded_x(k);
  const double half = t_quantile_975(other.degrees_of_freedom) * std::sqrt(other.covariance(k, k));
  return value - half <= e.ci_high && value + half >= e.ci_low ? e.value : value;
}

void judge(Estimate& e, double there, double cutoff, double factor, bool is_rigid,
           DynamicFit& fit) {
  const double moved = std::abs(there - e.value);
  if (moved <= kMovementNoted * e.value) return;
  if (is_rigid && (there <= e.value / kMovedInertia || there >= kMovedInertia * e.value)) {
    refuse(e, fmt::format("{:.3g} at a cut-off of {:.3g} Hz is {:.3g} at {:.3g} Hz, more than the "
                          "interval allows: the logs do not determine it; accelerate more",
                          e.value, cutoff, there, factor * cutoff));
    fit.verdicts[e.name] = "not identifiable";
    return;
  }
  fit.doubts.push_back(
      fmt::format("{}: {:.3g} at a cut-off of {:.3g} Hz is {:.3g} at {:.3g} Hz; "
                  "the difference is part of its sd",
                  e.name, e.value, cutoff, there, factor * cutoff));
  widen_interval(e, std::sqrt(1 + moved * moved / (e.sd * e.sd)));
}

/// Share of the squares of an acceleration, from a speed channel, that the channel's noise makes.
double noise_share(const EstimationTask& task, const EquationRows& e) {
  const DynamicJob& job = task.job;
  const LogPlan& plan = job.first_log().plan;
  if (!job.rigid || plan.has_measured(Channel::theta) || !plan.has(Channel::w)) return 0;
  const auto slot = static_cast<std::size_t>(plan.find(Channel::w));
  double noise = 0;
  for (const LogSurvey& log : job.logs)
    for (const PartSurvey& part : log.parts)
      if (job.wanted(part))
        noise = std::max(
            {noise, part.channels[slot].noise, part.channels[slot].quantum / std::sqrt(12.0)});
  const double rate = sample_rates(job.logs, job.wanted).lowest;
  const double made = velocity_noise(noise, job.settings.rows.signal.cutoff, rate);
  const auto n = static_cast<double>(std::max<Eigen::Index>(1, e.rows->n_rows()));
  const double squares = e.rows->r().col(0).squaredNorm() / n;
  return squares > 0 ? made * made / squares : 0;
}

void refuse_noisy(const EstimationTask& task, Estimation& estimation) {
  for (const EquationRows& e : task.equations) {
    Estimate* const inertia = inertia_of(e, 0, estimation.fit);
    const double share = inertia == nullptr ? 0 : noise_share(task, e);
    if (!(share > kNoisyShare)) continue;
    refuse(*inertia,
           fmt::format("{:.0f} % of the acceleration's squares are noise of the speed channel: the "
                       "logs do not determine it; accelerate more",
                       100 * std::min(1.0, share)));
    estimation.fit.verdicts[inertia->name] = "not identifiable";
  }
}

void check_at(const OtherCutoff& other, const EstimationTask& task, Estimation& estimation) {
  const double cutoff = task.job.settings.rows.signal.cutoff;
  for (std::size_t k = 0; k < other.equations.size(); ++k) {
    const EquationRows& e = other.equations[k];
    if (e.rows->n_rows() < 4 * task.equations[k].columns.count) continue;
    const LinearSolution solution = solve_equation(e, task.job.elastic, task.model);
    for (std::size_t p = 0; p < e.columns.parameters.size(); ++p) {
      Estimate* const found = inertia_of(e, p, estimation.fit);
      if (found != nullptr)
        judge(*found, value_there(*found, solution, p), cutoff, other.factor, task.job.rigid,
              estimation.fit);
    }
  }
}

/// Stretches of the wanted rows; empty: there are few enough.
std::vector<LogSurvey> rows_for_check(const DynamicJob& job) {
  const auto all = static_cast<double>(expected_rows(job.logs, job.wanted, RowSettings{}));
  if (all <= kRowsForCheck) return {};
  return stretches_of(job.logs, job.wanted, kRowsForCheck / all,
                      bridge_seconds(job.settings.rows.signal));
}

}  // namespace

std::vector<OtherCutoff> rows_at_other_cutoffs(const DynamicJob& job,
                                               const std::vector<EquationRows>& equations) {
  std::vector<OtherCutoff> all;
  const double cutoff = job.settings.rows.signal.cutoff;
  if (!(cutoff > 0) || systems_of(equations).size() < equations.size()) return all;
  const double rate = sample_rates(job.logs, job.wanted).lowest;
  const auto stretches = std::make_shared<const std::vector<LogSurvey>>(rows_for_check(job));
  for (const double factor : kOtherCutoffs) {
    if (factor * cutoff > kMostShareOfRate * rate) continue;
    DynamicJob other = with_cutoff_scaled(job, factor);
    if (!stretches->empty()) other.logs = *stretches;
    all.push_back({factor, make_equations(other, ElasticDetail::torque), stretches});
    collect_rows(other, all.back().equations);
  }
  return all;
}

void refuse_moving_inertias(const EstimationTask& task, const std::vector<OtherCutoff>& others,
                            Estimation& estimation) {
  const double cutoff = task.job.settings.rows.signal.cutoff;
  if (!(cutoff > 0) || systems_of(task.equations).size() < task.equations.size()) return;
  refuse_noisy(task, estimation);
  for (const OtherCutoff& other : others) check_at(other, task, estimation);
}

}  // namespace cablefit
