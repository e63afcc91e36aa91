#include "cablefit/dynamic/dynamic_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "cablefit/base/catalog.hpp"
#include "cablefit/dynamic/checks/cutoff_check.hpp"
#include "cablefit/dynamic/checks/low_cutoff.hpp"
#include "cablefit/dynamic/checks/sweep.hpp"
#include "cablefit/dynamic/checks/systematic.hpp"
#include "cablefit/dynamic/checks/validation.hpp"
#include "cablefit/dynamic/dynamic_figures.hpp"
#include "cablefit/dynamic/dynamic_notes.hpp"
#include "cablefit/dynamic/estimates/estimates.hpp"
#include "cablefit/dynamic/estimates/joint_estimates.hpp"
#include "cablefit/dynamic/estimators/estimators.hpp"
#include "cablefit/dynamic/ratios.hpp"
#include "cablefit/dynamic/rows/dynamic_job.hpp"
#include "cablefit/dynamic/rows/first_shapes.hpp"
#include "cablefit/dynamic/rows/requirements.hpp"
#include "cablefit/dynamic/rows/settled_effects.hpp"
#include "cablefit/model/effects/effects_per_joint.hpp"
#include "cablefit/model/rig/searched_radius.hpp"
#include "cablefit/samples/rows/agreement.hpp"
#include "cablefit/samples/rows/row_stream.hpp"
#include "cablefit/samples/rows/unused_rows.hpp"

namespace cablefit {
namespace {

constexpr std::array<DynamicModel, 4> kModels = {{
    {"linear", "tau_elas = K (theta - q), both sides with inertia, viscous and Coulomb friction",
     "Fichera & Grossard 2017, (14), (29), (31)", true},
    {"poly", "tau_elas = sum over taut cables of P_i or S_i sum_j k_ij l_i^(j+1)",
     "Fichera & Grossard 2017, (14), (19), (30), (31)", true},
    {"rigid", "J a + f_v v + f_s sgn(v) + offset = tau (+ tau_load)",
     "Khalil & Dombre 2004, ch. 12", false},
    {"ratios",
     "qdd = (K/J_link)(theta - q) - (f_v/J_link) qd - (f_s/J_link) sgn(qd), no torque measured",
     "Fichera & Grossard 2017, (14a), divided by J_M", false},
}};

/// |rows * combination| at its largest, by a second look at all rows of one equation.
double largest_residual(const DynamicJob& job, const EquationRows& e,
                        const Eigen::VectorXd& combination) {
  double largest = 0;
  stream_rows(
      job.logs, job.wanted, job.settings.rows, {&e.equation, 1}, job.options.samples.threads,
      [&](const RowBatch& batch) {
        const Eigen::MatrixXd& rows = batch.equations.front().rows;
        return rows.rows() > 0 ? (rows * combination).cwiseAbs().maxCoeff() : 0.0;
      },
      [&](double found) { largest = std::max(largest, found); });
  return largest;
}

/// Largest residuals of model number `m`, from the pass that collected the rows if that is certain.
void add_largest_errors(const DynamicJob& job, const std::vector<EquationRows>& equations,
                        const std::vector<LinearSolution>& solutions, std::size_t m,
                        DynamicFit& fit) {
  for (std::size_t k = 0; k < equations.size(); ++k) {
    const Eigen::VectorXd& combination = solutions[k].residual_combination;
    const auto certain = equations[k].peaks->largest(static_cast<Eigen::Index>(m), combination);
    fit.torque_error[equations[k].equation.name].max_abs =
        certain ? *certain : largest_residual(job, equations[k], combination);
  }
}

void add_cad(DynamicFit& fit, const Rig& rig) {
  for (Estimate& e : fit.parameters) {
    const auto found = rig.cad.find(e.name);
    if (found != rig.cad.end()) e.cad = found->second;
  }
}

/// What is held keeps the numbers that the model came with, and what the logs do not determine the
/// value about which the columns were made, without sd.
EffectsPerJoint with_estimates(EffectsPerJoint effects, const std::vector<Estimate>& parameters) {
  for (const Estimate& e : parameters) {
    Estimate* own = find_parameter(effects, e.name);
    if (own == nullptr || e.sd == 0) continue;
    const std::string name = own->name;
    const double value = std::isfinite(e.value) ? e.value : own->value;
    *own = e;
    own->name = name;
    own->value = value;
  }
  return effects;
}

/// Of what is still identified when all checks are done.
ParameterCovariance known_together(const JointEstimates& joint,
                                   const std::vector<Estimate>& parameters) {
  std::vector<std::string> names;
  for (const std::string& name : joint.names) {
    const Estimate* e = find_estimate(parameters, name);
    if (e == nullptr || e->not_identifiable.empty()) names.push_back(name);
  }
  return joint.covariance_of(names);
}

/// Warns when the estimator that was asked for was not used.
void note_other_estimator(const std::string& asked, Estimation& estimation) {
  const std::string& used = estimation.fit.estimator;
  if (asked == "auto" || used.empty() || used == asked) return;
  std::string why;
  for (const Decision& d : estimation.decisions)
    if (d.name.starts_with("estimator")) why = ": " + d.reason;
  estimation.fit.warnings.push_back(
      fmt::format("the estimator '{}' was not used, but '{}'{}", asked, used, why));
}

void fit_models(const DynamicJob& job, const std::vector<EquationRows>& equations,
                DynamicPreload& preload) {
  const Estimator& estimator = find_estimator(job.options.estimator);
  std::vector<std::vector<LinearSolution>> solutions;
  std::vector<OtherCutoff> others;
  if (estimator.by_filtered_rows) others = rows_at_other_cutoffs(job, equations);
  for (std::size_t m = 0; m < job.models.size(); ++m) {
    const EstimationTask task{job, equations, m};
    Estimation estimation = estimator.estimate(task);
    note_other_estimator(job.options.estimator, estimation);
    add_systematic(task, estimator.by_filtered_rows, estimation);
    if (estimator.by_filtered_rows) refuse_moving_inertias(task, others, estimation);
    DynamicFit& fit = estimation.fit;
    fit.model = job.models[m];
    if (fit.estimator.empty()) fit.estimator = estimator.name;
    if (!job.rigid && !fit.elastic) fit.elastic = *job.elastic[m];
    if (estimator.by_filtered_rows) note_low_cutoff(task, estimation, fit);
    add_largest_errors(job, equations, estimation.solutions, m, fit);
    add_cad(fit, job.rig());
    refuse_dependent(job.added, fit.parameters);
    for (const Estimate& e : fit.parameters)
      if (!e.not_identifiable.empty()) fit.verdicts[e.name] = "not identifiable";
    fit.effects = with_estimates(job.added, fit.parameters);
    if (estimation.joint) fit.covariance = known_together(*estimation.joint, fit.parameters);
    if (estimation.joint && fit.elastic)
      fit.derived = drive_quantities(*estimation.joint, &fit.elastic->transmission,
                                     job.rig().cables_given, job.rig().axes.all());
    if (job.options.sweep) fit.sweep = sweep_settings(job, estimator, m, fit);
    preload.fits.push_back(std::move(fit));
    solutions.push_back(std::move(estimation.solutions));
    preload.decisions.insert(preload.decisions.end(), estimation.decisions.begin(),
                             estimation.decisions.end());
  }
  judge({job, equations, solutions}, preload);
  if (!job.options.figures) return;
  preload.figures = dynamic_figures(job, equations, solutions, preload);
  for (const DynamicFit& fit : preload.fits)
    for (Figure& figure : trace_figures(fit.traces, fit.parameters)) {
      figure.section = preload.name;
      figure.group = "estimates over time, " + fit.model;
      preload.figures.push_back(std::move(figure));
    }
}

/// A curve that is not that of the cables bends every estimate, by how much no residual says.
void refuse_doubtful(const ElasticResult& elastic, DynamicPreload& preload) {
  for (const ElasticPreload& stage1 : elastic.preloads) {
    if (stage1.name != preload.name || stage1.shape_doubt.empty()) continue;
    for (DynamicFit& fit : preload.fits) {
      fit.covariance = {};
      for (Estimate& e : fit.parameters) {
        if (!e.not_identifiable.empty()) continue;
        refuse(e, "stage 1 does not describe the cables: " + stage1.shape_doubt);
        fit.verdicts[e.name] = "not identifiable";
      }
    }
  }
}

DynamicPreload fit_preload(DynamicJob job, const ElasticResult& elastic) {
  require_agreement(job.logs, job.wanted, job.preload);
  DynamicPreload preload;
  preload.name = job.preload;
  preload.axes = job.rig().axes.all();
  preload.rig_path = job.rig().path;
  require_torque(job);
  require_motion(job);
  note_load(job, preload);
  EffectsPerJoint wanted = std::exchange(job.added, with_values(job.added));
  choose_settings(job, preload, elastic);
  job.added = std::move(wanted);
  find_first_shapes(job);
  std::vector<EquationRows> equations;
  std::string still_moving;
  preload.windows = collect_settled(job, equations, still_moving);
  if (!still_moving.empty()) preload.warnings.push_back(std::move(still_moving));
  for (const EquationRows& e : equations) {
    require_rows(e, job);
    preload.counts[e.equation.name] = e.counts;
  }
  if (std::string unused = unused_rows_warning(preload.windows, equations.front().counts);
      !unused.empty())
    preload.warnings.push_back(std::move(unused));
  note_free_fall(job.rig().load, equations, preload);
  fit_models(job, equations, preload);
  note_extrapolations(job, equations, elastic, preload);
  keep_causes(job, equations, elastic, preload);
  refuse_doubtful(elastic, preload);
  note_open_curves(job, preload);
  note_blocked_friction(job, elastic, preload);
  preload.decisions.insert(preload.decisions.begin(), job.settings.decisions.begin(),
                           job.settings.decisions.end());
  preload.warnings.insert(preload.warnings.end(), job.settings.warnings.begin(),
                          job.settings.warnings.end());
  return preload;
}

bool any_torque(std::span<const LogSurvey> logs, const PartFilter& wanted) {
  return std::any_of(logs.begin(), logs.end(), [&](const LogSurvey& log) {
    return log.plan.has(Channel::tau) && std::any_of(log.parts.begin(), log.parts.end(), wanted);
  });
}

/// Effects are of one model: they go by its cables.
void check_effects(const DynamicOptions& options) {
  if (!any_effect(options.effects)) return;
  if (options.models.size() != 1 || options.models.front() == "ratios")
    throw usage_error("effects beyond the paper's are fitted with one model at a time",
                      "give --model poly, --model linear or --model rigid");
}

void check_names(const DynamicOptions& options) {
  find_estimator(options.estimator);
  for (const std::string& model : options.models) find_row(dynamic_models(), "model", model);
}

}  // namespace

std::span<const DynamicModel> dynamic_models() { return kModels; }

DynamicResult fit_dynamic(std::span<const LogSurvey> logs, const ElasticResult& elastic,
                          const DynamicOptions& options) {
  check_names(options);
  check_effects(options);
  DynamicResult result;
  result.warnings = input_warnings(logs);
  for (std::string& warning : input_warnings(options.validation))
    result.warnings.push_back(std::move(warning));
  for (const LogSurvey& log : logs) {
    result.inputs.push_back({log.plan.path, log.sha256, log.n_rows});
  }
  const std::vector<std::string> names = preload_names(logs, [&](const PartSurvey& part) {
    return part.phase == Phase::moving &&
           (options.preload.empty() || options.preload == part.preload);
  });
  if (names.empty())
    throw input_error({logs.empty() ? "" : logs.front().plan.path, 0, 0}, "no moving log",
                      "give a log in which the link moves, or a 'phase' column that says so");
  const bool rigid = options.models.size() == 1 && options.models.front() == "rigid";
  const bool ratios = options.models.size() == 1 && options.models.front() == "ratios";
  if (ratios)
    for (const LogSurvey& log : logs)
      require_one_joint(log.plan, "--model ratios supports one joint");
  if (!options.validation.empty()) {
    if (ratios)
      throw usage_error("--validate compares torques, and --model ratios has none",
                        "validate a fit of another model");
    require_judgeable(options.validation, names, logs.front(), rigid);
    for (const LogSurvey& log : options.validation)
      result.inputs.push_back({log.plan.path, log.sha256, log.n_rows});
  }
  for (const std::string& name : names) {
    const PartFilter wanted = [name](const PartSurvey& part) {
      return part.phase == Phase::moving && part.preload == name;
    };
    if (ratios || (!rigid && !any_torque(logs, wanted))) {
      result.preloads.push_back(fit_ratios(logs, name, wanted, options));
      continue;
    }
    DynamicJob job{logs, options, name, wanted, {}, options.models, rigid, {}, {}};
    job.added = of_joints(options.effects, job.n_joints());
    for (const LogSurvey& log : logs)
      if (std::any_of(log.parts.begin(), log.parts.end(), wanted))
        require_channels(log.plan, rigid);
    if (!rigid)
      for (const LogSurvey& log : logs) refuse_searched_radius(log.plan.rig, "stage 2");
    if (!rigid)
      for (const std::string& model : options.models)
        job.elastic.push_back(&require_stage1(elastic, name, model));
    require_fittable(job.added, rigid,
                     rigid ? std::span<const Cable>() : job.elastic.front()->transmission.cables);
    result.preloads.push_back(fit_preload(std::move(job), elastic));
  }
  return result;
}

}  // namespace cablefit
