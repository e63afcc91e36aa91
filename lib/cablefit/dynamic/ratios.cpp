#include "cablefit/dynamic/ratios.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "cablefit/dynamic/dynamic_figures.hpp"
#include "cablefit/estimate/fit/parameter_estimate.hpp"
#include "cablefit/samples/rows/agreement.hpp"
#include "cablefit/samples/rows/row_stream.hpp"

namespace cablefit {
namespace {

constexpr std::array<ParameterInfo, 4> kRatios = {
    {{"K/J_link", "K/J_link", "1/s^2", "stiffness over inertia", 0},
     {"f_v/J_link", "f_v/J_link", "1/s", "viscous friction over inertia", 0},
     {"f_s/J_link", "f_s/J_link", "rad/s^2", "Coulomb friction over inertia", 0},
     {"constant", "constant", "rad/s^2", "a constant torque over inertia"}}};
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
                            options.robust_sd);
  RowStatistics rows = blank;
  RowCounts& counts = preload.counts[equation.name];
  preload.windows = stream_rows(
      logs, wanted, settings, {&equation, 1}, options.samples.threads,
      [&](const RowBatch& batch) {
        RowStatistics part = blank.empty_copy();
        part.add(batch.equations[0].rows, batch.equations[0].numbers);
        return std::pair(std::move(part), batch.equations[0].counts);
      },
      [&](std::pair<RowStatistics, RowCounts>&& result) {
        rows.add(std::move(result.first));
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

bool have_torque(std::span<const LogSurvey> logs, const PartFilter& wanted) {
  return std::any_of(logs.begin(), logs.end(), [&](const LogSurvey& log) {
    return log.plan.has(Channel::tau) && std::any_of(log.parts.begin(), log.parts.end(), wanted);
  });
}

/// Lists by name the parameters that only a torque would determine.
void refuse_absolute(bool has_torque, DynamicFit& fit) {
  for (const char* absolute : {"J_link", "J_motor", "f_v", "f_s", "f_vm", "f_sm", "offset"}) {
    Estimate e;
    e.name = e.symbol = absolute;
    e.not_identifiable = has_torque
                             ? "model ratios does not use the torque: fit model poly"
                             : "no torque is measured: only ratios to J_link can be identified";
    fit.verdicts[absolute] = "not identifiable";
    fit.parameters.push_back(e);
  }
}

DynamicFit make_fit(const LinearSolution& s, const DynamicOptions& options, Axes axes,
                    bool has_torque) {
  DynamicFit fit;
  fit.model = "ratios";
  fit.estimator = options.estimator;
  for (std::size_t k = 0; k < 3; ++k)
    fit.parameters.push_back(
        estimate_of(kRatios[k], axes, s, static_cast<Eigen::Index>(k), {options.robust_sd}));
  refuse_absolute(has_torque, fit);
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
  preload.axes = rig.axes.all();
  preload.rig_path = rig.path;
  const ChosenSettings settings = moving_settings(logs, wanted, options.samples, 0);
  preload.decisions = settings.decisions;
  Equation equation = ratio_equation(settings.rest_speed_q);
  equation.cutoff = settings.cutoff_q;
  const RowStatistics rows = collect(logs, wanted, options, settings.rows, equation, preload);
  const LinearProblem problem = ratio_problem();
  const LinearSolution s = solve(rows, problem);
  const bool has_torque = have_torque(logs, wanted);
  preload.fits.push_back(make_fit(s, options, preload.axes, has_torque));
  if (options.figures)
    preload.figures = ratio_figures({logs, wanted, settings.rows, options.samples.threads, equation,
                                     problem.response, s.residual_combination, s.rms()},
                                    preload);
  if (!has_torque)
    preload.warnings.emplace_back(
        "no torque in the moving logs: ratios to J_link are all that can be identified");
  return preload;
}

}  // namespace cablefit
