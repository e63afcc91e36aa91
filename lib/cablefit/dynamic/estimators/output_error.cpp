// Output error: the motion that the fitted model would make of the measured torque, held against
// the measured positions themselves. No filter, no derivatives, no rest threshold; stage 1 takes
// part with what it knows.
#include "cablefit/dynamic/output_error/output_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/dynamic/estimates/estimates.hpp"
#include "cablefit/dynamic/estimators/least_squares_fit.hpp"
#include "cablefit/dynamic/estimators/output_error_floor.hpp"
#include "cablefit/dynamic/estimators/rows.hpp"
#include "cablefit/dynamic/loops/log_copy.hpp"
#include "cablefit/dynamic/loops/model_of_solutions.hpp"
#include "cablefit/dynamic/loops/noise_free_loop.hpp"
#include "cablefit/dynamic/output_error/log_stretches.hpp"
#include "cablefit/dynamic/output_error/stage1_prior.hpp"
#include "cablefit/estimate/fit/parameter_estimate.hpp"
#include "cablefit/model/effects/effects_per_joint.hpp"

namespace cablefit::estimation {
namespace {

// Every row is simulated some thirty times, 20 us a time. More rows than this are looked at in
// evenly spaced stretches, which leaves J_motor of the paper's rig 0.02 % uncertain.
constexpr double kMostRows = 600000;
constexpr double kFarFromStage1 = 3;  // sd of stage 1
constexpr double kNoShape = 1;        // relative sd of a shape such as v_s
constexpr double kWrongNoise = 1.5;   // whitened rms, 1 when the noise levels are right
// Of whitened residuals from row to row, 0 when the model is right and the torque noise white.
constexpr double kWrongModel = 0.3;

/// A load torque that logs give, and no law of the rig file.
bool has_load(const DynamicJob& job) {
  const LoadLaw* law = job.rig().load.law;
  if (law != nullptr && !law->from_column) return false;
  return std::any_of(job.logs.begin(), job.logs.end(),
                     [](const LogSurvey& log) { return log.plan.has(Channel::tau_load); });
}

/// Why these logs cannot be fitted by output error; empty when they can.
std::string obstacle(const EstimationTask& task, const Model& start) {
  const DynamicJob& job = task.job;
  if (job.rigid && any_effect(job.added) && has_load(job))
    return "an added effect of a rigid drive may depend on its load, and output error adds the "
           "logged load to the torque";
  for (const LogSurvey& log : job.logs) {
    if (std::none_of(log.parts.begin(), log.parts.end(), job.wanted)) continue;
    for (int joint = 0; joint < job.n_joints(); ++joint)
      if (!log.plan.has_measured(Channel::theta, joint) ||
          (!job.rigid && !log.plan.has(Channel::q, joint)))
        return fmt::format("{} has no positions to compare with", log.plan.path);
  }
  for (const ModelParameter& p : model_parameters(start))
    if (is_inertia(start, p) && !(parameter_value(start, p) > 0))
      return fmt::format("weighted least squares, from which it starts, finds no positive {}",
                         p.name);
  return "";
}

Estimation stay_with_least_squares(const EstimationTask& task, Estimation start,
                                   const std::string& why) {
  start.fit.estimator = "wls";
  start.decisions.push_back({task.decision_name("estimator"), "wls", "no output error: " + why});
  return start;
}

/// The wanted rows of the job, or of many evenly spaced stretches.
struct FittedRows {
  std::vector<MeasuredStretch> stretches;
  std::string note;
  std::vector<LogSurvey> parts = {};  ///< the logs' rows that are fitted; empty: all
};

FittedRows rows_of(const DynamicJob& job) {
  double all = 0;
  for (const LogSurvey& log : job.logs)
    for (const PartSurvey& part : log.parts)
      if (job.wanted(part)) all += static_cast<double>(part.n_rows);
  if (all <= kMostRows) return {measured_stretches(job, job.logs), ""};
  const double share = kMostRows / all;
  const double bridge = bridge_seconds(job.settings.rows.signal);
  std::vector<LogSurvey> parts = stretches_of(job.logs, job.wanted, share, bridge);
  std::vector<MeasuredStretch> stretches = measured_stretches(job, parts);
  return {std::move(stretches),
          fmt::format(", on {:.2g} % of the rows in evenly spaced stretches", 100 * share),
          std::move(parts)};
}

/// Even a surrogate controller, which follows what was measured and so keeps out no disturbance,
/// knows nothing of the torque's noise, which the smoothed motion has: J -0.4 % where that noise is
/// coloured.
LoopPlan add_noise_free_loop(const DynamicJob& job, const FittedRows& rows,
                             OutputErrorOptions& options) {
  const std::span<const LogSurvey> logs =
      rows.parts.empty() ? job.logs : std::span<const LogSurvey>(rows.parts);
  LoopPlan plan = plan_loop(job, logs);
  if (plan.kind == LoopKind::none) return plan;
  options.noise_free_loop = [&job, logs, plan](const Model& model) {
    const SimulatedLogs simulated = simulate_loops(job, logs, model, plan);
    if (!simulated.failure.empty()) return NoiseFreeLogs{{}, {}, simulated.failure};
    return NoiseFreeLogs{measured_stretches(job, simulated.logs),
                         measured_stretches(job, simulated.logs, true), ""};
  };
  return plan;
}

/// Whether a parameter has a column of its own, and is not given.
bool is_free(const EstimationTask& task, const std::string& name) {
  for (const EquationRows& e : task.equations)
    for (const DynamicParameter& p : e.columns.parameters)
      if (p.name == name) return !p.given;
  return false;
}

OutputErrorOptions options_of(const EstimationTask& task, const Model& start) {
  OutputErrorOptions options;
  options.position_sd = position_noise_of(task.job);
  options.threads = task.job.options.samples.threads;
  for (const EquationRows& e : task.equations)
    for (const DynamicParameter& p : e.columns.parameters)
      if (p.given) options.held.push_back(p.name);
  for (const ModelParameter& p : model_parameters(start))
    if (p.kind == ParameterKind::added && !is_free(task, p.name)) options.held.push_back(p.name);
  if (const ElasticFit* stage1 = task.stage1()) {
    Stage1Prior prior = stage1_prior(start, *stage1);
    options.prior = std::move(prior.prior);
    options.held.insert(options.held.end(), prior.held.begin(), prior.held.end());
  }
  return options;
}

double lower_of(const EquationRows& e, Eigen::Index k) {
  return e.columns.parameters[static_cast<std::size_t>(k)].info.lower;
}

/// Why this estimate is not reliable; empty when it is.
std::string doubt(const EquationRows& e, Eigen::Index k, const OutputErrorFit& oe,
                  const Estimate& found) {
  const DynamicParameter& parameter = e.columns.parameters[static_cast<std::size_t>(k)];
  if (parameter.is_nonlinear && found.not_identifiable.starts_with("its column is zero"))
    return "the coefficient of its effect is 0";
  if (!found.not_identifiable.empty()) return found.not_identifiable;
  const bool is_inertia = parameter.is_inertia;
  if (parameter.is_nonlinear && found.sd > kNoShape * std::abs(found.value))
    return "its sd is larger than its value: the logs do not determine it";
  if (parameter.is_nonlinear && !found.active_bound.empty())
    return fmt::format("it is at the end of its range, {}: the logs do not determine it",
                       found.active_bound);
  if (is_inertia) {
    std::string alias = inertia_alias(*e.rows, e.columns, k);
    if (!alias.empty()) return alias;
  }
  if (!oe.converged)
    return fmt::format("output error stopped at {:.4g} without converging", found.value);
  if (is_inertia && !(found.ci_low > 0))
    return fmt::format("the 95 % interval of {:.3g} reaches 0; accelerate more", found.value);
  return "";
}

Estimate estimate_of(const EstimationTask& task, const EquationRows& equation, Eigen::Index k,
                     const OutputErrorFit& oe) {
  const std::string& name = equation.columns.parameters[static_cast<std::size_t>(k)].name;
  Estimate e = *find_estimate(oe.parameters, name);
  if (!task.job.options.robust_sd && std::isfinite(e.sd)) {
    e.sd = e.sd_white;
    if (e.active_bound.empty())
      cablefit::set_interval(e, oe.degrees_of_freedom, lower_of(equation, k));
  }
  const std::string why = doubt(equation, k, oe, e);
  return why.empty() ? e : refused_estimate(e, why);
}

/// Residuals of the equation's rows, filtered as ever, with the parameters of output error: what
/// figures, tests of residuals and torque errors are made of.
LinearSolution solution_of(const EstimationTask& task, const EquationRows& e,
                           const OutputErrorFit& oe, const ElasticFit* stage1,
                           LinearSolution solution) {
  std::vector<const ElasticFit*> elastic = task.job.elastic;
  if (stage1 != nullptr) elastic[task.model] = stage1;
  solution.residual_combination = dynamic_response(e.columns, elastic, task.model);
  for (std::size_t k = 0; k < e.columns.parameters.size(); ++k) {
    const DynamicParameter& parameter = e.columns.parameters[k];
    const auto i = static_cast<Eigen::Index>(k);
    if (!parameter.given) {
      const double value = find_estimate(oe.parameters, parameter.name)->value;
      solution.x(i) = std::isfinite(value) ? value - parameter.origin : 0;
    }
    solution.residual_combination(i) = -(parameter.given ? *parameter.given : solution.x(i));
  }
  solution.rss = (e.rows->r() * solution.residual_combination).squaredNorm();
  solution.effective_rows = oe.effective_rows / static_cast<double>(oe.noise.position.size());
  return solution;
}

std::string sd_reason_of(const EstimationTask& task, const OutputErrorFit& oe) {
  if (!task.job.options.robust_sd) return "white: as asked for";
  return fmt::format(
      "HAC of the scores: whitened residuals are correlated {:.2f} from row to row, effective rows "
      "{:.0f} of {}",
      oe.correlation, oe.effective_rows, oe.n_rows);
}

/// "link 0.0012, motor 0.49"
std::string per_axis(const EstimationTask& task, const Eigen::VectorXd& values) {
  const int n_joints = task.job.n_joints();
  std::string text;
  for (Eigen::Index a = 0; a < values.size(); ++a) {
    const char* side = task.job.rigid ? "rigid" : a < n_joints ? "link" : "motor";
    text += fmt::format("{}{} {:.2g}", text.empty() ? "" : ", ",
                        joint_parameter_name(side, static_cast<int>(a) % n_joints + 1, n_joints),
                        values[a]);
  }
  return text;
}

void note_fit(const EstimationTask& task, const FittedRows& rows, const LoopPlan& loop,
              const OutputErrorFit& oe, Estimation& out) {
  const Axes axes = task.job.rig().axes.all();
  out.decisions.push_back(
      {task.decision_name("output error"),
       fmt::format("{} rounds, {} simulations", oe.n_rounds, oe.n_passes),
       fmt::format("started from the wls fit; torque noise {} {} by maximum likelihood, encoder "
                   "noise {} {}; whitened residual {:.3g}{}",
                   per_axis(task, oe.noise.force), torque_unit(axes),
                   per_axis(task, oe.noise.position), unit_for(axes, "rad"), oe.residual_rms,
                   rows.note)});
  if (!oe.instruments.empty())
    out.decisions.push_back({task.decision_name("instruments"),
                             oe.instrumented ? source_of_instruments(loop) : "none",
                             oe.instruments});
  for (const auto* warnings : {&loop.warnings, &oe.warnings})
    out.fit.warnings.insert(out.fit.warnings.end(), warnings->begin(), warnings->end());
  if (any_effect(task.job.added))
    out.fit.warnings.emplace_back(
        "output error: the intervals of effects that act at low speed may be too narrow; compare "
        "with --estimator iv");
  if (oe.residual_rms > kWrongNoise || oe.residual_rms < 1 / kWrongNoise)
    out.fit.warnings.push_back(
        fmt::format("the residual of output error is {:.2g} times the assumed noise: the model or "
                    "the rig's sensors are wrong",
                    oe.residual_rms));
  if (std::abs(oe.correlation) > kWrongModel)
    out.fit.warnings.push_back(
        fmt::format("the residual of output error is correlated from row to row ({:.2f}): the "
                    "model is wrong, or the torque noise is far from white, and the estimates are "
                    "biased by it",
                    oe.correlation));
}

void note_stage1(const EstimationTask& task, const OutputErrorOptions& options,
                 const OutputErrorFit& oe, Estimation& out) {
  if (task.job.rigid) return;
  const Stage1Shift shift = largest_shift(options.prior, oe);
  if (shift.name.empty()) {
    out.decisions.push_back(
        {task.decision_name("elastic coefficients"), "held", "stage 1 gives no sd"});
    return;
  }
  out.decisions.push_back(
      {task.decision_name("elastic coefficients"), "fitted",
       fmt::format("with stage 1 and its robust covariance as prior; l_o and theta_0 held; {} "
                   "changes most, by {:+.2f} sd of stage 1",
                   shift.name, shift.in_sd)});
  if (std::abs(shift.in_sd) > kFarFromStage1)
    out.fit.warnings.push_back(
        fmt::format("the moving logs disagree with stage 1: they change {} from {:.5g} to {:.5g}, "
                    "{:.2g} sd of stage 1",
                    shift.name, shift.from, shift.to, std::abs(shift.in_sd)));
}

/// Of an equation, or of all that share its parameters.
void fill_parameters(const EstimationTask& task, const EquationRows& e, const OutputErrorFit& oe,
                     const Estimation& start, DynamicFit& fit) {
  for (Eigen::Index i = 0; i < e.columns.n_effects; ++i) {
    const DynamicParameter& parameter = e.columns.parameters[static_cast<std::size_t>(i)];
    fit.parameters.push_back(parameter.given ? *find_estimate(start.fit.parameters, parameter.name)
                                             : estimate_of(task, e, i, oe));
    fit.verdicts[parameter.name] = parameter.given ? "given"
                                   : fit.parameters.back().not_identifiable.empty()
                                       ? "identified"
                                       : "not identifiable";
  }
}

/// Everything but decisions and notes.
void fill(const EstimationTask& task, const OutputErrorFit& oe, const Estimation& start,
          Estimation& out) {
  const bool robust = task.job.options.robust_sd;
  if (const ElasticFit* stage1 = task.stage1())
    out.fit.elastic = refined_stage1(*stage1, oe, robust);
  const ElasticFit* elastic = out.fit.elastic ? &*out.fit.elastic : nullptr;
  for (const std::vector<std::size_t>& system : systems_of(task.equations))
    fill_parameters(task, task.equations[system.front()], oe, start, out.fit);
  for (std::size_t k = 0; k < task.equations.size(); ++k) {
    const EquationRows& e = task.equations[k];
    const std::string& name = e.equation.name;
    out.solutions.push_back(solution_of(task, e, oe, elastic, start.solutions[k]));
    add_errors(*e.rows, name, out.solutions.back(), out.fit);
    out.fit.sd_reason[name] = sd_reason_of(task, oe);
  }
}

/// All that was fitted together and stands on no bound.
JointEstimates joint_estimates_of(const OutputErrorFit& oe, const DynamicFit& fit) {
  JointEstimates joint;
  std::vector<Eigen::Index> kept;
  for (std::size_t k = 0; k < oe.parameters.size(); ++k) {
    const Estimate& e = oe.parameters[k];
    const Estimate* start = find_estimate(fit.parameters, e.name);
    if (!e.not_identifiable.empty() || !e.active_bound.empty()) continue;
    if (start != nullptr && !start->not_identifiable.empty()) continue;
    joint.names.push_back(e.name);
    kept.push_back(static_cast<Eigen::Index>(k));
  }
  joint.value.resize(static_cast<Eigen::Index>(kept.size()));
  for (std::size_t i = 0; i < kept.size(); ++i)
    joint.value(static_cast<Eigen::Index>(i)) =
        oe.parameters[static_cast<std::size_t>(kept[i])].value;
  joint.covariance = oe.covariance(kept, kept);
  joint.degrees_of_freedom = oe.degrees_of_freedom;
  return joint;
}

/// Of effects, which may bend at low speed. What the user gives is used as it is.
void add_floor(const EstimationTask& task, const OutputErrorOptions& options,
               const OutputErrorFit& oe, Estimation& out) {
  const DynamicOptions& asked = task.job.options;
  if (!any_effect(task.job.added) || !oe.converged || !asked.robust_sd || asked.method_floor)
    return;
  OutputErrorFloor floor = output_error_floor(task.job, oe, options);
  out.fit.method_floor = std::move(floor.sd);
  out.floor_note = std::move(floor.note);
}

Estimation estimate_by_simulation(const EstimationTask& task) {
  Estimation start = least_squares_fit(task, Weighting::by_residual);
  const DynamicJob& job = task.job;
  const Model model = model_of_solutions(job, task.equations, start.solutions, task.model);
  const std::string why = obstacle(task, model);
  if (!why.empty()) return stay_with_least_squares(task, std::move(start), why);
  const FittedRows rows = rows_of(job);
  if (rows.stretches.empty())
    return stay_with_least_squares(task, std::move(start), "no stretch of 16 rows without a gap");
  OutputErrorOptions options = options_of(task, model);
  // Beside Stribeck friction the instruments of a surrogate loop put J_motor 3 sd too low.
  const LoopPlan loop =
      !any_effect(job.added) ? add_noise_free_loop(job, rows, options) : LoopPlan{};
  const OutputErrorFit oe = fit_output_error(model, rows.stretches, options);
  if (oe.parameters.empty()) return stay_with_least_squares(task, std::move(start), oe.message);
  Estimation out;
  fill(task, oe, start, out);
  out.joint = joint_estimates_of(oe, out.fit);
  note_fit(task, rows, loop, oe, out);
  note_stage1(task, options, oe, out);
  add_floor(task, options, oe, out);
  return out;
}

}  // namespace

Estimator output_error() {
  return {"output-error",
          "simulated positions follow the measured ones, torque noise and stiffness as unknowns",
          "Jazwinski 1970, 5.3; Ljung 1999, 7.2", estimate_by_simulation, false};
}

}  // namespace cablefit::estimation
