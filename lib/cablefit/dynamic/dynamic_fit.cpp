#include "cablefit/dynamic/dynamic_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "cablefit/base/catalog.hpp"
#include "cablefit/dynamic/dynamic_figures.hpp"
#include "cablefit/dynamic/dynamic_job.hpp"
#include "cablefit/dynamic/estimates.hpp"
#include "cablefit/dynamic/ratios.hpp"
#include "cablefit/samples/agreement.hpp"

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

constexpr std::array<Estimator, 2> kEstimators = {{
    {"ols", "ordinary least squares by streamed QR, all equations of weight one",
     "Golub & Van Loan 2013, ch. 5", false},
    {"wls", "each equation weighted by 1/variance of its own residual", "Gautier 1997", true},
}};

constexpr double kRangeSlack = 0.02;          // of stage 1's range: rounding, not extrapolation
constexpr std::size_t kRowsPerParameter = 4;  // fewer say nothing

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

/// Stage 1's range is where its curve was fitted; beyond it the curve is a guess.
struct Range {
  double low = kUnbounded, high = -kUnbounded;
};

Range deflections_of(const ElasticPreload& stage1, int joint) {
  if (stage1.joints.empty()) return {stage1.deflection_low, stage1.deflection_high};
  const ElasticJoint& own = stage1.joints[static_cast<std::size_t>(joint)];
  return {own.deflection_low, own.deflection_high};
}

void note_extrapolation(const ElasticPreload& stage1, const std::vector<EquationRows>& equations,
                        int joint, double theta_0, DynamicPreload& preload) {
  const Range known = deflections_of(stage1, joint);
  const double slack = kRangeSlack * (known.high - known.low);
  double low = kUnbounded, high = -kUnbounded;
  for (const EquationRows& e : equations) {
    if (e.columns.place.joint != joint) continue;
    low = std::min(low, e.deflection_low - theta_0);
    high = std::max(high, e.deflection_high - theta_0);
  }
  if (low >= known.low - slack && high <= known.high + slack) return;
  preload.warnings.push_back(fmt::format(
      "{}deflections of {:.3g} to {:.3g} {} leave the range of stage 1 ({:.3g} to {:.3g}): the "
      "elastic torque is extrapolated there",
      stage1.joints.empty() ? "" : fmt::format("joint {}: ", joint + 1), low, high, stage1.unit,
      known.low, known.high));
}

void fit_models(const DynamicJob& job, const std::vector<EquationRows>& equations,
                const ElasticResult& elastic, DynamicPreload& preload) {
  std::vector<std::vector<LinearSolution>> solutions;
  for (std::size_t m = 0; m < job.models.size(); ++m) {
    DynamicFit fit;
    fit.model = job.models[m];
    fit.estimator = job.options.estimator;
    const ElasticFit* stage1 = job.rigid ? nullptr : job.elastic[m];
    if (stage1 != nullptr) fit.elastic = *stage1;
    solutions.emplace_back();
    solutions.back().resize(equations.size());
    for (const std::vector<std::size_t>& system : systems_of(equations)) {
      const EquationRows& first = equations[system.front()];
      std::optional<RowStatistics> stacked;
      if (system.size() > 1) stacked = stacked_rows(equations, system, job.elastic, m);
      const RowStatistics& rows = stacked ? *stacked : *first.rows;
      const LinearSolution solution =
          solve_rows(rows, first.columns, job.elastic, m, job.rig().linear_motion);
      add_estimates(rows, first.columns, solution, stage1, m, job.rig().linear_motion,
                    job.options.honest_sd, fit);
      for (const std::size_t k : system) {
        add_errors(*equations[k].rows, equations[k].equation.name, solution, fit);
        solutions.back()[k] = solution;
      }
    }
    add_largest_errors(job, equations, solutions.back(), m, fit);
    add_cad(fit, job.rig());
    preload.fits.push_back(std::move(fit));
  }
  if (job.options.figures) preload.figures = dynamic_figures(job, equations, solutions, preload);
  for (const ElasticPreload& stage1 : elastic.preloads)
    for (int joint = 0; joint < job.n_joints(); ++joint)
      if (!job.rigid && stage1.name == job.preload)
        note_extrapolation(stage1, equations, joint,
                           job.elastic.front()->transmission.theta_0(joint), preload);
}

void note_load(const DynamicJob& job, DynamicPreload& preload) {
  const Load& load = job.rig().load;
  if (load.law != nullptr) {
    preload.load_inertia = load.law->inertia(load.parameters);
    const bool by_position =
        load.law->torque(load.parameters, 0.1) != load.law->torque(load.parameters, -0.2);
    if (job.rigid && !load.law->from_column && by_position)
      require_channel(job.first_log().plan, Channel::theta, "a load that depends on position");
    return;
  }
  for (const LogSurvey& log : job.logs) {
    if (job.rigid || std::none_of(log.parts.begin(), log.parts.end(), job.wanted)) continue;
    const int n = job.n_joints();
    for (int joint = 0; joint < n; ++joint)
      if (!log.plan.has(Channel::tau_load, joint))
        preload.warnings.push_back(fmt::format(
            "{}: no tau_load{} column and no load law in the rig file: the load torque is taken as "
            "0",
            log.plan.path, n > 1 ? std::to_string(joint + 1) : ""));
  }
}

/// A hanging mass that the link outruns is not the load that the law says.
void note_free_fall(const Load& load, const std::vector<EquationRows>& equations,
                    DynamicPreload& preload) {
  if (load.law == nullptr || load.law->free_fall == nullptr) return;
  const EquationRows& link = equations.front();  // or the one of a rigid drive
  const double most = load.law->free_fall(load.parameters);
  if (link.acceleration > most)
    preload.warnings.push_back(fmt::format(
        "the link accelerates by up to {:.3g} rad/s^2, beyond the {:.3g} rad/s^2 (g/r) at which a "
        "'{}' load lets its rope go slack: there tau_load is not what the rig file says; move more "
        "gently or hang the mass on a smaller radius",
        link.acceleration, most, load.law->name));
}

/// The curve of stage 1 must hold the link, not push it.
void require_restoring(const ElasticFit& fit, const std::string& preload) {
  if (fit.transmission.cables.empty() && !(fit.transmission.linear_stiffness.minCoeff() > 0))
    throw Error(ErrorKind::not_identifiable,
                fmt::format("stage 1 of preload '{:.40}' has a negative stiffness: the sign of "
                            "tau, theta or q is turned "
                            "round; set it in the rig file and run 'cablefit elastic' again",
                            preload));
}

bool torque_changes(const DynamicJob& job, int joint) {
  for (const LogSurvey& log : job.logs) {
    const int k = log.plan.find(Channel::tau, joint);
    for (const PartSurvey& part : log.parts)
      if (k >= 0 && job.wanted(part) && part.channels[static_cast<std::size_t>(k)].range() > 0)
        return true;
  }
  return false;
}

void require_torque(const DynamicJob& job) {
  const int n = job.n_joints();
  for (int joint = 0; joint < n; ++joint)
    if (!torque_changes(job, joint))
      throw input_error({job.first_log().plan.path, 0, 0},
                        fmt::format("tau{} never changes", n > 1 ? std::to_string(joint + 1) : ""),
                        "check which column the torque is");
}

void require_rows(const EquationRows& e, const std::string& preload) {
  if (e.counts.rows_used >= kRowsPerParameter * static_cast<std::size_t>(e.columns.n_effects))
    return;
  throw Error(
      ErrorKind::not_identifiable,
      fmt::format("preload '{}': only {} rows in motion on the {} side; record a longer or faster "
                  "motion, or lower --rest-speed",
                  preload, e.counts.rows_used, e.equation.name));
}

DynamicPreload fit_preload(DynamicJob job, const ElasticResult& elastic) {
  require_agreement(job.logs, job.wanted, job.preload);
  DynamicPreload preload;
  if (job.rig().arm.kind != nullptr) job.arm = &job.rig().arm;
  preload.name = job.preload;
  preload.linear_motion = job.rig().linear_motion;
  preload.rig_path = job.rig().path;
  require_torque(job);
  note_load(job, preload);
  choose_settings(job, preload, elastic);
  std::vector<EquationRows> equations = make_equations(job);
  preload.windows = collect_rows(job, equations);
  for (const EquationRows& e : equations) {
    require_rows(e, job.preload);
    preload.counts[e.equation.name] = e.counts;
  }
  note_free_fall(job.rig().load, equations, preload);
  fit_models(job, equations, elastic, preload);
  preload.decisions = job.settings.decisions;
  preload.warnings.insert(preload.warnings.end(), job.settings.warnings.begin(),
                          job.settings.warnings.end());
  return preload;
}

void require_channels(const LogPlan& plan, bool rigid) {
  require_channel(plan, Channel::tau, rigid ? "the rigid model" : "stage 2");
  if (rigid) {
    if (!plan.has(Channel::w)) require_channel(plan, Channel::theta, "the rigid model");
    return;
  }
  require_channel(plan, Channel::q, "an elastic model",
                  "add it, map it in a rig file, or use --model rigid");
  require_channel(plan, Channel::theta, "an elastic model");
}

const ElasticFit& stage1_fit(const ElasticResult& elastic, const std::string& preload,
                             const std::string& model) {
  for (const ElasticPreload& p : elastic.preloads) {
    if (p.name != preload) continue;
    if (const ElasticFit* fit = p.find(model)) return *fit;
    throw Error(ErrorKind::input, fmt::format("stage 1 has no '{}' fit for preload '{:.40}'; run "
                                              "'cablefit elastic' again",
                                              model, preload));
  }
  std::string names;
  for (const ElasticPreload& p : elastic.preloads) names += (names.empty() ? "" : ", ") + p.name;
  throw Error(
      ErrorKind::input,
      fmt::format("stage 1 has no preload '{:.40}', which the moving logs are of; it has {}; run "
                  "'cablefit elastic' on a blocked log of it, or name the preloads alike",
                  preload, names.empty() ? "none" : names));
}

bool any_torque(std::span<const LogSurvey> logs, const PartFilter& wanted) {
  return std::any_of(logs.begin(), logs.end(), [&](const LogSurvey& log) {
    return log.plan.has(Channel::tau) && std::any_of(log.parts.begin(), log.parts.end(), wanted);
  });
}

void check_names(const DynamicOptions& options) {
  std::vector<std::string_view> known;
  for (const Estimator& row : kEstimators) known.push_back(row.name);
  if (std::find(known.begin(), known.end(), options.estimator) == known.end())
    throw usage_error(fmt::format("unknown estimator '{:.40}'", options.estimator),
                      suggestion(options.estimator, known));
  known.clear();
  for (const DynamicModel& row : kModels) known.push_back(row.name);
  for (const std::string& model : options.models)
    if (std::find(known.begin(), known.end(), model) == known.end())
      throw usage_error(fmt::format("unknown model '{:.40}'", model), suggestion(model, known));
}

}  // namespace

std::span<const DynamicModel> dynamic_models() { return kModels; }
std::span<const Estimator> estimators() { return kEstimators; }

DynamicResult fit_dynamic(std::span<const LogSurvey> logs, const ElasticResult& elastic,
                          const DynamicOptions& options) {
  check_names(options);
  DynamicResult result;
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
  if (rigid || ratios)
    for (const LogSurvey& log : logs)
      require_one_joint(log.plan,
                        fmt::format("--model {} is made for one", options.models.front()));
  for (const std::string& name : names) {
    const PartFilter wanted = [name](const PartSurvey& part) {
      return part.phase == Phase::moving && part.preload == name;
    };
    if (ratios || (!rigid && !any_torque(logs, wanted))) {
      result.preloads.push_back(fit_ratios(logs, name, wanted, options));
      continue;
    }
    DynamicJob job{logs, options, name, wanted, {}, options.models, rigid, {}, {}, nullptr};
    for (const LogSurvey& log : logs)
      if (std::any_of(log.parts.begin(), log.parts.end(), wanted))
        require_channels(log.plan, rigid);
    if (!rigid)
      for (const std::string& model : options.models) {
        job.elastic.push_back(&stage1_fit(elastic, name, model));
        require_restoring(*job.elastic.back(), name);
      }
    result.preloads.push_back(fit_preload(std::move(job), elastic));
  }
  return result;
}

}  // namespace cablefit
