#include "cablefit/dynamic/ratios.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "cablefit/dynamic/dynamic_figures.hpp"
#include "cablefit/estimate/least_squares.hpp"
#include "cablefit/estimate/long_run.hpp"
#include "cablefit/samples/agreement.hpp"

namespace cablefit {
namespace {

struct Ratio {
  const char* name;
  const char* unit;
  const char* linear_unit;
  double lower;
};
constexpr std::array<Ratio, 4> kRatios = {{{"K/J_link", "1/s^2", "1/s^2", 0},
                                           {"f_v/J_link", "1/s", "1/s", 0},
                                           {"f_s/J_link", "rad/s^2", "m/s^2", 0},
                                           {"constant", "rad/s^2", "m/s^2", -kUnbounded}}};
constexpr Eigen::Index kResponse = 4;

Equation ratio_equation(double rest_speed) {
  Equation equation;
  equation.name = "link";
  equation.columns.assign(kResponse + 1, "");
  equation.averaged.assign(kResponse + 1, true);
  equation.rest_speed = rest_speed;
  equation.speed = [](const Signals& signals) { return signals.joints[0].qd; };
  equation.fill = [](const Signals& signals, Eigen::Ref<Eigen::MatrixXd> out) {
    const JointSignals& s = signals.joints[0];
    out.col(0) = s.theta - s.q;
    out.col(1) = -s.qd;
    out.col(2) = -s.q_direction;
    out.col(3).setOnes();
    out.col(kResponse) = s.qdd;
  };
  return equation;
}

/// Streams all wanted rows; fills the counts of `preload`.
RowStatistics collect(std::span<const LogSurvey> logs, const PartFilter& wanted,
                      const DynamicOptions& options, const RowSettings& settings,
                      const Equation& equation, DynamicPreload& preload) {
  const RowStatistics blank(kResponse + 1, expected_rows(logs, wanted, settings),
                            options.honest_sd);
  RowStatistics rows = blank;
  RowCounts& counts = preload.counts[equation.name];
  preload.windows = stream_rows(
      logs, wanted, settings, {&equation, 1}, options.samples.threads,
      [&](const RowBatch& batch) {
        RowStatistics part = blank.empty_copy();
        part.add(batch.equations[0].rows, batch.equations[0].numbers);
        return std::pair(std::move(part), batch.equations[0].counts);
      },
      [&](const std::pair<RowStatistics, RowCounts>& result) {
        rows.add(result.first);
        counts += result.second;
      });
  return rows;
}

LinearProblem ratio_problem() {
  LinearProblem problem;
  for (std::size_t k = 0; k < kRatios.size(); ++k) {
    problem.regressors.push_back(static_cast<Eigen::Index>(k));
    problem.names.emplace_back(kRatios[k].name);
    problem.lower.push_back(kRatios[k].lower);
  }
  problem.response = Eigen::VectorXd::Unit(kResponse + 1, kResponse);
  return problem;
}

Estimate ratio_estimate(const LinearSolution& s, std::size_t which, bool linear_motion,
                        bool honest_sd) {
  const Ratio& ratio = kRatios[which];
  const auto k = static_cast<Eigen::Index>(which);
  Estimate e;
  e.name = e.symbol = ratio.name;
  e.unit = linear_motion ? ratio.linear_unit : ratio.unit;
  e.not_identifiable = s.not_identifiable[which];
  if (e.not_identifiable.empty()) e.value = s.x(k);
  const double t = t_quantile_975(s.degrees_of_freedom);
  if (s.at_bound[which]) {
    e.active_bound = fmt::format("{} >= 0", e.name);
    e.sd = s.unbounded_sd(k);
    e.ci_low = 0;
    e.ci_high = std::max(0.0, s.unbounded_x(k) + t * e.sd);
  } else if (e.not_identifiable.empty()) {
    e.sd_white = std::sqrt(s.covariance_white(k, k));
    e.sd = honest_sd ? std::sqrt(s.covariance(k, k)) : e.sd_white;
    e.ci_low = e.value - t * e.sd;
    e.ci_high = e.value + t * e.sd;
  }
  return e;
}

/// What only a measured torque would tell: said by name.
void refuse_absolute(DynamicFit& fit) {
  for (const char* absolute : {"J_link", "J_motor", "f_v", "f_s", "f_vm", "f_sm", "offset"}) {
    Estimate e;
    e.name = e.symbol = absolute;
    e.not_identifiable = "no torque is measured: only ratios to J_link show";
    fit.verdicts[absolute] = "not identifiable";
    fit.parameters.push_back(e);
  }
}

DynamicFit make_fit(const LinearSolution& s, const DynamicOptions& options, bool linear_motion) {
  DynamicFit fit;
  fit.model = "ratios";
  fit.estimator = options.estimator;
  for (std::size_t k = 0; k < 3; ++k)
    fit.parameters.push_back(ratio_estimate(s, k, linear_motion, options.honest_sd));
  refuse_absolute(fit);
  fit.effective_rows["link"] = s.effective_rows;
  fit.condition["link"] = s.condition;
  fit.warnings = s.warnings;
  return fit;
}

}  // namespace

DynamicPreload fit_ratios(std::span<const LogSurvey> logs, const std::string& name,
                          const PartFilter& wanted, const DynamicOptions& options) {
  for (const LogSurvey& log : logs) {
    require_channel(log.plan, Channel::q, "the ratios of a flexible joint");
    require_channel(log.plan, Channel::theta, "the ratios of a flexible joint");
  }
  require_agreement(logs, wanted, name);
  const Rig& rig = first_log_with(logs, wanted).plan.rig;
  DynamicPreload preload;
  preload.name = name;
  preload.linear_motion = rig.linear_motion;
  preload.rig_path = rig.path;
  const ChosenSettings settings = moving_settings(logs, wanted, options.samples, 0);
  preload.decisions = settings.decisions;
  Equation equation = ratio_equation(settings.rest_speed_q);
  equation.cutoff = settings.cutoff_q;
  const RowStatistics rows = collect(logs, wanted, options, settings.rows, equation, preload);
  const LinearProblem problem = ratio_problem();
  const LinearSolution s = solve(rows, problem);
  preload.fits.push_back(make_fit(s, options, preload.linear_motion));
  if (options.figures)
    preload.figures = ratio_figures({logs, wanted, settings.rows, options.samples.threads, equation,
                                     problem.response, s.residual_combination, s.rms()},
                                    preload);
  preload.warnings.emplace_back(
      "no torque in the log: ratios to J_link are all that can be identified");
  return preload;
}

}  // namespace cablefit
