#include "cablefit/identify/identify_estimates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "cablefit/elastic/passivity.hpp"
#include "cablefit/estimate/least_squares.hpp"
#include "cablefit/estimate/long_run.hpp"
#include "cablefit/estimate/parameter_estimate.hpp"
#include "cablefit/identify/determined.hpp"

namespace cablefit {
namespace {

constexpr double kCorrelationWarning = 0.95;  // estimation-rules: warn above

double sd_at(const Eigen::MatrixXd& covariance, Eigen::Index k) {
  return std::sqrt(std::max(0.0, covariance(k, k)));
}

/// The fit without inequalities, for the interval at a bound.
void add_unbounded(const JointFit& fit, JudgedPoint& judged) {
  JointProblem problem = joint_problem(fit.jobs, fit.layout, judged.point.input(), fit.weights, {});
  const JointSolution s = solve(problem);
  judged.unbounded_x = s.x;
  judged.unbounded_sd = joint_covariance(problem, s).covariance.diagonal().cwiseSqrt();
}

bool stands_on_bound(const JointFit& fit, const JudgedPoint& judged, Eigen::Index k) {
  const PhysicalBounds bounds = physical_bounds(fit, judged.point.l_o);
  return std::any_of(
      judged.point.solution.active.begin(), judged.point.solution.active.end(),
      [&](Eigen::Index i) { return bounds.parameters[static_cast<std::size_t>(i)] == k; });
}

void set_on_bound(const JudgedPoint& judged, Eigen::Index k, Estimate& e) {
  e.active_bound = fmt::format("{} >= 0", e.name);
  e.value = 0;
  e.sd = judged.unbounded_sd(k);
  e.ci_low = 0;
  e.ci_high = std::max(
      0.0, judged.unbounded_x(k) + t_quantile_975(judged.covariance.degrees_of_freedom(k)) * e.sd);
}

Estimate estimate_at(const JointFit& fit, const JudgedPoint& judged, Eigen::Index k, bool honest) {
  const JointParameter& p = fit.layout.parameters[static_cast<std::size_t>(k)];
  Estimate e;
  e.name = p.name;
  e.symbol = p.symbol;
  e.unit = fit.jobs.front().linear_motion &&
                   !(k < fit.layout.n_coefficients && fit.jobs.front().cable_space)
               ? linear_unit(p.unit)
               : p.unit;
  e.not_identifiable = why_undetermined(fit, judged, k);
  if (!e.not_identifiable.empty()) return e;
  e.value = k < fit.layout.n_linear ? judged.point.solution.x(k)
                                    : judged.point.l_o[static_cast<std::size_t>(p.preload)](
                                          static_cast<Eigen::Index>(p.cable));
  if (k < fit.layout.n_linear && stands_on_bound(fit, judged, k)) {
    set_on_bound(judged, k, e);
    return e;
  }
  e.sd_white = sd_at(judged.covariance.white, k);
  e.sd = honest ? sd_at(judged.covariance.covariance, k) : e.sd_white;
  set_interval(e, judged.covariance.degrees_of_freedom(k), p.lower);
  return e;
}

/// Torque of the fitted cables as a combination of an equation's columns.
Eigen::VectorXd elastic_combination(const JointEquation& equation, const JointFit& fit,
                                    const Eigen::VectorXd& x) {
  const JointColumns c = joint_columns(equation, fit.layout.n_coefficients);
  Eigen::VectorXd combination = Eigen::VectorXd::Zero(c.count);
  combination.segment(c.basis, fit.layout.n_coefficients) = x.head(fit.layout.n_coefficients);
  return combination;
}

/// The slope of the straight line through `response`, beside the equation's own columns.
LinearSolution line_through(const RowStatistics& rows, const JointEquation& equation,
                            const JointFit& fit, const Eigen::VectorXd& response) {
  LinearProblem problem;
  problem.regressors = {joint_columns(equation, fit.layout.n_coefficients).deflection};
  problem.names = {"K"};
  for (const JointEquation::Own& own : equation.own) {
    problem.regressors.push_back(own.column);
    problem.names.push_back(own.name);
  }
  problem.response = response;
  return solve(rows, problem);
}

std::optional<LineStiffness> line_of(const JointFit& fit, const JudgedPoint& judged,
                                     std::size_t job) {
  std::size_t e = 0;
  for (const JointRecord& record : fit.jobs[job].records)
    for (const JointEquation& equation : record.equations) {
      const RowStatistics& rows = (*judged.point.rows[job])[e];
      const EquationFacts& facts = fit.facts[job][e];
      ++e;
      if (equation.base.name != "blocked") continue;
      const Eigen::Index count = joint_columns(equation, fit.layout.n_coefficients).count;
      const LinearSolution measured =
          line_through(rows, equation, fit, Eigen::VectorXd::Unit(count, equation.response));
      const LinearSolution model = line_through(
          rows, equation, fit, elastic_combination(equation, fit, judged.point.solution.x));
      return LineStiffness{facts.deflection_low, facts.deflection_high, measured.x(0),
                           std::sqrt(measured.covariance(0, 0)), model.x(0)};
    }
  return std::nullopt;
}

std::vector<IdentifyEquation> equations_of(const JointFit& fit, const JudgedPoint& judged,
                                           std::size_t job) {
  std::size_t block = 0, e = 0;
  for (std::size_t j = 0; j < job; ++j) block += fit.facts[j].size();
  std::vector<IdentifyEquation> equations;
  for (const JointRecord& record : fit.jobs[job].records)
    for (const JointEquation& equation : record.equations) {
      const double n = static_cast<double>((*judged.point.rows[job])[e].n_rows());
      const double rss = judged.point.solution.rss[block];
      IdentifyEquation out{equation.base.name, fit.facts[job][e].counts, 0, 0, 0};
      out.rms = n > 0 ? std::sqrt(rss / n) : 0;
      out.weight = fit.weights[block];
      out.effective_rows = std::min(n, out.weight * rss);
      equations.push_back(out);
      ++block;
      ++e;
    }
  return equations;
}

/// The elastic coefficients of one cable always lean on each other, and on its l_o.
std::vector<std::string> correlation_warnings(const JointFit& fit, const JudgedPoint& judged) {
  std::vector<std::string> warnings;
  const Eigen::MatrixXd& c = judged.linearised.solve_operator;
  for (Eigen::Index i = fit.layout.n_coefficients; i < fit.layout.n_linear; ++i)
    for (Eigen::Index k = 0; k < i; ++k) {
      const double scale = std::sqrt(c(i, i) * c(k, k));
      if (!(scale > 0) || std::abs(c(i, k)) < kCorrelationWarning * scale) continue;
      warnings.push_back(fmt::format("{} and {} can hardly be told apart: correlation {:.3f}",
                                     judged.problem.names[static_cast<std::size_t>(k)],
                                     judged.problem.names[static_cast<std::size_t>(i)],
                                     c(i, k) / scale));
    }
  return warnings;
}

std::vector<EffectInstance> effects_of(Side side, const std::vector<Estimate>& parameters) {
  std::vector<EffectInstance> instances;
  for (const Effect& effect : base_effects(side)) {
    EffectInstance instance{&effect, {}};
    for (const ParameterInfo& info : effect.parameters) {
      const Estimate* e = find_estimate(parameters, info.name);
      if (e == nullptr || !e->not_identifiable.empty()) return {};
      instance.parameters.push_back(*e);
    }
    instances.push_back(std::move(instance));
  }
  return instances;
}

/// What `simulate` runs; none where a parameter is missing.
std::optional<Model> model_of(const IdentifyResult& result, const IdentifyPreload& preload,
                              const PreloadFacts& facts) {
  std::vector<Estimate> all = result.parameters;
  all.insert(all.end(), preload.parameters.begin(), preload.parameters.end());
  Model model;
  model.name = "poly";
  model.preload = preload.name;
  model.rig = facts.rig;
  model.rig.transmission = preload.transmission;
  if (model.rig.torque_hold == TorqueHold::automatic)
    model.rig.torque_hold = facts.delay.held ? TorqueHold::zoh : TorqueHold::none;
  model.joints = {{effects_of(Side::link, all), effects_of(Side::motor, all)}};
  if (model.joints.front().link.empty() || model.joints.front().motor.empty()) return std::nullopt;
  model.transmission = preload.transmission;
  for (const Cable& cable : preload.transmission.cables) {
    for (int k = 0; k < cable.n_coefficients(); ++k) {
      const Estimate* e = find_estimate(all, coefficient_name(cable, k, facts.rig.cables_given));
      if (e == nullptr || !e->not_identifiable.empty()) return std::nullopt;
      model.elastic.push_back(*e);
    }
  }
  for (const Cable& cable : preload.transmission.cables)
    if (const Estimate* e = find_estimate(all, elongation_name(cable))) model.elastic.push_back(*e);
  return model;
}

void add_cad(const Rig& rig, std::vector<Estimate>& parameters) {
  for (Estimate& e : parameters)
    if (const auto found = rig.cad.find(e.name); found != rig.cad.end()) e.cad = found->second;
}

IdentifyPreload preload_of(const JointFit& fit, const JudgedPoint& judged, std::size_t job,
                           const PreloadFacts& facts) {
  IdentifyPreload preload;
  preload.name = facts.name;
  preload.rig_path = facts.rig.path;
  preload.transmission =
      fitted_cables(fit.jobs[job], judged.point.l_o[job], judged.point.solution.x);
  preload.elongations = fit.elongations(job, judged.point.l_o[job]);
  const DeflectionRange range = reference_deflections(preload.transmission, preload.elongations);
  preload.deflection_low = range.low;
  preload.deflection_high = range.high;
  const PreloadTorques torques = preload_torques(preload.transmission);
  preload.equilibrium =
      std::max(torques.link.cwiseAbs().maxCoeff(), torques.motor.cwiseAbs().maxCoeff());
  preload.line = line_of(fit, judged, job);
  preload.slack =
      slack_points(preload.transmission, preload.deflection_low, preload.deflection_high);
  preload.equations = equations_of(fit, judged, job);
  preload.delay = facts.delay;
  preload.resonance = facts.resonance;
  preload.load_inertia = facts.load_inertia;
  preload.decisions = facts.decisions;
  preload.warnings = facts.warnings;
  return preload;
}

void note_pushing(const JointFit& fit, const IdentifyPreload& preload, IdentifyResult& result) {
  for (std::size_t c = 0; c < preload.transmission.cables.size(); ++c) {
    const Cable& cable = preload.transmission.cables[c];
    if (const std::optional<Push> push = find_push(cable, preload.elongations[c].high))
      result.warnings.push_back(
          push_text(cable, *push, {fit.jobs.front().cable_space, fit.jobs.front().linear_motion}));
  }
}

}  // namespace

JudgedPoint judge_point(const JointFit& fit, JointPoint point) {
  JudgedPoint judged{std::move(point), {}, {}, {}, {}, {}};
  judged.point.solution = solve_bounded(fit, judged.point);
  judged.problem = linearised(fit, judged.point);
  judged.linearised = solve(judged.problem);
  judged.covariance = joint_covariance(judged.problem, judged.linearised);
  if (!judged.point.solution.active.empty()) add_unbounded(fit, judged);
  return judged;
}

std::vector<Estimate> joint_estimates(const JointFit& fit, const JudgedPoint& judged, bool honest) {
  std::vector<Estimate> estimates;
  for (std::size_t k = 0; k < fit.layout.parameters.size(); ++k)
    estimates.push_back(estimate_at(fit, judged, static_cast<Eigen::Index>(k), honest));
  return estimates;
}

void describe(const JointFit& fit, const JudgedPoint& judged,
              const std::vector<PreloadFacts>& facts, const IdentifyOptions& options,
              IdentifyResult& result) {
  for (std::size_t j = 0; j < fit.jobs.size(); ++j)
    result.preloads.push_back(preload_of(fit, judged, j, facts[j]));
  const std::vector<Estimate> estimates = joint_estimates(fit, judged, options.honest_sd);
  for (std::size_t k = 0; k < estimates.size(); ++k) {
    if (estimates[k].name == kCreep) continue;
    const int preload = fit.layout.parameters[k].preload;
    (preload == kShared ? result.parameters
                        : result.preloads[static_cast<std::size_t>(preload)].parameters)
        .push_back(estimates[k]);
  }
  add_cad(facts.front().rig, result.parameters);
  for (std::size_t j = 0; j < facts.size(); ++j) {
    add_cad(facts[j].rig, result.preloads[j].parameters);
    result.preloads[j].model = model_of(result, result.preloads[j], facts[j]);
    note_pushing(fit, result.preloads[j], result);
  }
  const PhysicalBounds bounds = physical_bounds(fit, judged.point.l_o);
  for (const Eigen::Index i : judged.point.solution.active)
    result.active_bounds.push_back(bounds.texts[static_cast<std::size_t>(i)]);
  result.condition = judged.linearised.condition_scaled;
  const Eigen::Index n = fit.layout.n_coefficients;
  result.coefficient_covariance =
      (options.honest_sd ? judged.covariance.covariance : judged.covariance.white)
          .topLeftCorner(n, n);
  const std::vector<std::string> correlated = correlation_warnings(fit, judged);
  result.warnings.insert(result.warnings.end(), correlated.begin(), correlated.end());
}

}  // namespace cablefit
