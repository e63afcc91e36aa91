#include "cablefit/dynamic/dynamic_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "cablefit/base/catalog.hpp"
#include "cablefit/dynamic/dynamic_columns.hpp"
#include "cablefit/dynamic/estimates.hpp"
#include "cablefit/dynamic/ratios.hpp"
#include "cablefit/dynamic/torque_delay.hpp"
#include "cablefit/estimate/least_squares.hpp"

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
    {"ols", "ordinary least squares by streamed Householder QR, all equations of weight one",
     "Golub & Van Loan 2013, ch. 5", false},
    {"wls", "each equation weighted by 1/variance of its own residual", "Gautier 1997", true},
}};

struct Job {
  std::span<const LogSurvey> logs;
  const DynamicOptions& options;
  std::string preload;
  PartFilter wanted;
  std::vector<const ElasticFit*> elastic;  // one per elastic model asked for
  std::vector<std::string> models;
  bool rigid = false;
  ChosenSettings settings;
};

/// One equation with its rows.
struct EquationFit {
  DynamicColumns columns;
  Equation equation;
  std::optional<RowStatistics> rows;
  RowCounts counts;
};

const PartSurvey* first_part(const Job& job, const LogSurvey** log = nullptr) {
  for (const LogSurvey& l : job.logs)
    for (const PartSurvey& part : l.parts)
      if (job.wanted(part)) {
        if (log != nullptr) *log = &l;
        return &part;
      }
  return nullptr;
}

// f0 of the elastic drive needs inertias, which are what is looked for. A first fit with a generous
// band gives them; the CAD values are never used.
double resonance(double stiffness, double j_link, double j_motor) {
  if (!(j_link > 0) || !(j_motor > 0) || !(stiffness > 0)) return 0;
  return std::sqrt(stiffness * (1 / j_motor + 1 / j_link)) / (2 * 3.14159265358979323846);
}

std::vector<EquationFit> make_equations(const Job& job) {
  std::vector<EquationFit> equations;
  const std::vector<Side> sides =
      job.rigid ? std::vector<Side>{Side::rigid} : std::vector<Side>{Side::link, Side::motor};
  for (const Side side : sides) {
    EquationFit e;
    e.columns = dynamic_columns(side, job.elastic);
    const double rest =
        side == Side::link ? job.settings.rest_speed_q : job.settings.rest_speed_theta;
    e.equation =
        dynamic_equation(e.columns, job.elastic, job.settings.rows.signal.torque_held, rest);
    equations.push_back(std::move(e));
  }
  return equations;
}

WindowCounts collect(const Job& job, std::vector<EquationFit>& equations) {
  std::vector<Equation> plain;
  std::vector<RowStatistics> blank;
  const Eigen::Index expected = expected_rows(job.logs, job.wanted, job.settings.rows);
  for (EquationFit& e : equations) {
    plain.push_back(e.equation);
    blank.emplace_back(e.columns.count, expected, job.options.honest_sd);
    e.rows = blank.back();
  }
  struct Result {
    std::vector<RowStatistics> rows;
    std::vector<RowCounts> counts;
  };
  return stream_rows(
      job.logs, job.wanted, job.settings.rows, plain, job.options.samples.threads,
      [&](const RowBatch& batch) {
        Result result;
        for (std::size_t k = 0; k < plain.size(); ++k) {
          result.rows.push_back(blank[k].empty_copy());
          result.rows.back().add(batch.equations[k].rows, batch.equations[k].numbers);
          result.counts.push_back(batch.equations[k].counts);
        }
        return result;
      },
      [&](const Result& result) {
        for (std::size_t k = 0; k < plain.size(); ++k) {
          equations[k].rows->add(result.rows[k]);
          equations[k].counts += result.counts[k];
        }
      });
}

LinearSolution solve_equation(const EquationFit& e, const std::vector<const ElasticFit*>& elastic,
                              std::size_t which) {
  LinearProblem problem;
  for (const Effect* effect : e.columns.effects)
    for (const ParameterInfo& info : effect->parameters) {
      problem.regressors.push_back(static_cast<Eigen::Index>(problem.regressors.size()));
      problem.names.emplace_back(info.name);
      problem.lower.push_back(info.lower);
    }
  problem.response = dynamic_response(e.columns, elastic, which);
  return solve(*e.rows, problem);
}

/// Largest residual needs the rows again; everything else is in the statistics.
void measure_largest(const Job& job, const std::vector<EquationFit>& equations,
                     const std::vector<std::vector<LinearSolution>>& solutions,
                     std::vector<DynamicFit>& fits) {
  std::vector<Equation> plain;
  for (const EquationFit& e : equations) plain.push_back(e.equation);
  const std::size_t n_fits = fits.size();
  std::vector<double> worst(n_fits * plain.size(), 0);
  stream_rows(
      job.logs, job.wanted, job.settings.rows, plain, job.options.samples.threads,
      [&](const RowBatch& batch) {
        std::vector<double> found(worst.size(), 0);
        for (std::size_t k = 0; k < plain.size(); ++k)
          for (std::size_t f = 0; f < n_fits; ++f)
            if (batch.equations[k].rows.rows() > 0)
              found[f * plain.size() + k] =
                  (batch.equations[k].rows * solutions[f][k].residual_combination)
                      .cwiseAbs()
                      .maxCoeff();
        return found;
      },
      [&](const std::vector<double>& found) {
        for (std::size_t i = 0; i < worst.size(); ++i) worst[i] = std::max(worst[i], found[i]);
      });
  for (std::size_t f = 0; f < n_fits; ++f)
    for (std::size_t k = 0; k < plain.size(); ++k)
      fits[f].torque_error[plain[k].name].max_abs = worst[f * plain.size() + k];
}

/// The stiffness at the middle of the torque range used, for f0.
double typical_stiffness(const ElasticFit& fit, const ElasticPreload& preload) {
  if (fit.transmission.cables.empty()) return fit.transmission.linear_stiffness(0);
  double sum = 0;
  const double deflection = 0.5 * std::max(-preload.deflection_low, preload.deflection_high);
  for (const Cable& cable : fit.transmission.cables) {
    const double r = cable.motor_radius(0);
    for (const double phi : {-deflection, deflection})
      sum += 0.5 * r * r * cable.stiffness(r * phi + cable.initial_elongation);
  }
  return sum;
}

void choose_settings(Job& job, DynamicPreload& preload, const ElasticResult& elastic) {
  const Side side = job.rigid ? Side::rigid : Side::motor;
  double f0 = 0;
  if (!job.rigid) {
    // First fit with the widest band the differences allow, for the inertias alone.
    SampleOptions wide = job.options.samples;
    const LogSurvey* log = nullptr;
    const PartSurvey* part = first_part(job, &log);
    if (!wide.cutoff) wide.cutoff = 0.15 / part->period;
    job.settings = moving_settings(job.logs, job.wanted, wide, 0);
    std::vector<EquationFit> pilot = make_equations(job);
    const Eigen::Index expected = expected_rows(job.logs, job.wanted, job.settings.rows);
    const double rate = 1 / part->period;
    for (EquationFit& e : pilot) e.rows.emplace(e.columns.count, expected);
    for (const PilotWindow& p : pilot_windows(job.logs, job.wanted, job.settings.rows.signal,
                                              row_halo(job.settings.rows, rate), 8))
      for (EquationFit& e : pilot) {
        const RowBatch batch =
            make_rows(p.window, job.logs[p.log], 0, job.settings.rows, {&e.equation, 1});
        e.rows->add(batch.equations[0].rows, batch.equations[0].numbers);
      }
    const std::size_t last = job.elastic.size() - 1;
    const double j_link = solve_equation(pilot[0], job.elastic, last).x(0);
    const double j_motor = solve_equation(pilot[1], job.elastic, last).x(0);
    const ElasticPreload* stage1 = nullptr;
    for (const ElasticPreload& p : elastic.preloads)
      if (p.name == job.preload) stage1 = &p;
    f0 = resonance(typical_stiffness(*job.elastic[last], *stage1), j_link, j_motor);
    if (f0 > 0.5 / part->period) f0 = 0;
  }
  preload.resonance = f0;
  job.settings = moving_settings(job.logs, job.wanted, job.options.samples, f0);

  const LogSurvey* log = nullptr;
  first_part(job, &log);
  const Rig& rig = log->plan.rig;
  job.settings.rows.signal.torque_period = rig.torque_period;
  const TorqueHold hold = job.options.samples.torque_hold.value_or(rig.torque_hold);
  const double rest = job.settings.rest_speed_theta;
  preload.delay = estimate_torque_delay(job.logs, job.wanted, job.settings.rows, rest, side,
                                        job.rigid ? nullptr : job.elastic.back());
  if (hold == TorqueHold::automatic) {
    job.settings.decisions.push_back(
        {"torque hold", preload.delay.held ? "zoh" : "none", preload.delay.reason});
  } else {
    preload.delay.held = hold == TorqueHold::zoh;
    job.settings.decisions.push_back(
        {"torque hold", preload.delay.held ? "zoh" : "none", "given; " + preload.delay.reason});
  }
  job.settings.rows.signal.torque_held = preload.delay.held;
}

void add_cad(DynamicFit& fit, const Rig& rig) {
  for (Estimate& e : fit.parameters) {
    const auto found = rig.cad.find(e.name);
    if (found != rig.cad.end()) e.cad = found->second;
  }
}

std::vector<DynamicFit> fit_models(const Job& job, const std::vector<EquationFit>& equations,
                                   const Rig& rig) {
  std::vector<DynamicFit> fits;
  std::vector<std::vector<LinearSolution>> solutions;
  for (std::size_t m = 0; m < job.models.size(); ++m) {
    DynamicFit fit;
    fit.model = job.models[m];
    fit.estimator = job.options.estimator;
    if (!job.rigid) fit.elastic = *job.elastic[m];
    std::vector<LinearSolution> by_equation;
    for (const EquationFit& e : equations) {
      LinearSolution s = solve_equation(e, job.elastic, m);
      const ElasticFit* stage1 = job.rigid ? nullptr : job.elastic[m];
      add_estimates(*e.rows, e.columns, s, stage1, m, rig.linear_motion, job.options.honest_sd,
                    fit);
      by_equation.push_back(std::move(s));
    }
    add_cad(fit, rig);
    solutions.push_back(std::move(by_equation));
    fits.push_back(std::move(fit));
  }
  measure_largest(job, equations, solutions, fits);
  return fits;
}

void note_extrapolation(const Job& job, const ElasticResult& elastic, DynamicPreload& preload) {
  for (const ElasticPreload& stage1 : elastic.preloads) {
    if (stage1.name != job.preload) continue;
    double low = 0, high = 0;
    const LogSurvey* log = nullptr;
    const PartSurvey* part = first_part(job, &log);
    for (const PilotWindow& p :
         pilot_windows(job.logs, job.wanted, job.settings.rows.signal,
                       signal_halo(job.settings.rows.signal, 1 / part->period), 4)) {
      const Signals signals =
          make_signals(p.window, job.logs[p.log].plan, job.settings.rows.signal);
      const Eigen::ArrayXd phi = signals.joints[0].theta - signals.joints[0].q -
                                 job.elastic.front()->transmission.theta_0(0);
      low = std::min(low, phi.minCoeff());
      high = std::max(high, phi.maxCoeff());
    }
    const double span = stage1.deflection_high - stage1.deflection_low;
    if (low < stage1.deflection_low - 0.02 * span || high > stage1.deflection_high + 0.02 * span)
      preload.warnings.push_back(
          fmt::format("deflections of {:.3g} to {:.3g} {} leave the range of stage 1 ({:.3g} to "
                      "{:.3g}): the elastic "
                      "torque is extrapolated there",
                      low, high, stage1.unit, stage1.deflection_low, stage1.deflection_high));
  }
}

void note_load(const LogSurvey& log, DynamicPreload& preload, bool rigid) {
  const Load& load = log.plan.rig.load;
  if (load.law != nullptr) {
    preload.load_inertia = load.law->inertia(load.parameters);
    return;
  }
  if (!rigid && !log.plan.has(Channel::tau_load))
    preload.warnings.push_back(
        "no tau_load column and no load law in the rig file: the load torque is taken as 0");
}

DynamicPreload fit_preload(Job job, const ElasticResult& elastic) {
  DynamicPreload preload;
  preload.name = job.preload;
  const LogSurvey* log = nullptr;
  first_part(job, &log);
  const Rig& rig = log->plan.rig;
  preload.linear_motion = rig.linear_motion;
  preload.rig_path = rig.path;
  note_load(*log, preload, job.rigid);
  choose_settings(job, preload, elastic);
  std::vector<EquationFit> equations = make_equations(job);
  preload.windows = collect(job, equations);
  for (const EquationFit& e : equations) {
    preload.counts[e.equation.name] = e.counts;
    if (e.counts.rows_used < 4 * static_cast<std::size_t>(e.columns.n_effects))
      throw Error(ErrorKind::not_identifiable,
                  fmt::format("preload '{}': only {} rows in motion on the {} side; record a "
                              "longer or faster motion, "
                              "or lower --rest-speed",
                              job.preload, e.counts.rows_used, e.equation.name));
  }
  preload.fits = fit_models(job, equations, rig);
  preload.decisions = job.settings.decisions;
  preload.warnings.insert(preload.warnings.end(), job.settings.warnings.begin(),
                          job.settings.warnings.end());
  if (!job.rigid) note_extrapolation(job, elastic, preload);
  return preload;
}

void require_channels(const LogPlan& plan, bool rigid) {
  require_channel(plan, Channel::tau, rigid ? "the rigid model" : "stage 2");
  if (rigid) {
    if (!plan.has(Channel::w)) require_channel(plan, Channel::theta, "the rigid model");
    return;
  }
  require_channel(plan, Channel::q, "an elastic model; without it use --model rigid");
  require_channel(plan, Channel::theta, "an elastic model");
}

const ElasticFit& stage1_fit(const ElasticResult& elastic, const std::string& preload,
                             const std::string& model, const std::string& path) {
  for (const ElasticPreload& p : elastic.preloads) {
    if (p.name != preload) continue;
    if (const ElasticFit* fit = p.find(model)) return *fit;
    throw input_error({path, 0, 0},
                      fmt::format("stage 1 has no '{}' fit for preload '{}'", model, preload),
                      "run 'cablefit elastic' again");
  }
  std::vector<std::string_view> known;
  for (const ElasticPreload& p : elastic.preloads) known.push_back(p.name);
  throw input_error({path, 0, 0}, fmt::format("no stage-1 result for preload '{:.40}'", preload),
                    known.empty() ? "run 'cablefit elastic' on a blocked log of this preload first"
                                  : suggestion(preload, known));
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
  std::set<std::string> names;
  bool torque = true;
  for (const LogSurvey& log : logs) {
    result.inputs.push_back({log.plan.path, log.sha256, log.n_rows});
    torque &= log.plan.has(Channel::tau);
    for (const PartSurvey& part : log.parts)
      if (part.phase == Phase::moving &&
          (options.preload.empty() || options.preload == part.preload))
        names.insert(part.preload);
  }
  if (names.empty())
    throw input_error({logs.empty() ? "" : logs.front().plan.path, 0, 0}, "no moving log",
                      "give a log in which the link moves, or a 'phase' column that says so");
  const bool rigid = options.models.size() == 1 && options.models.front() == "rigid";
  const bool ratios = options.models.size() == 1 && options.models.front() == "ratios";
  for (const std::string& name : names) {
    const PartFilter wanted = [name](const PartSurvey& part) {
      return part.phase == Phase::moving && part.preload == name;
    };
    if (ratios || (!torque && !rigid)) {
      result.preloads.push_back(fit_ratios(logs, name, wanted, options));
      continue;
    }
    Job job{logs, options, name, wanted, {}, options.models, rigid, {}};
    for (const LogSurvey& log : logs) require_channels(log.plan, rigid);
    if (!rigid)
      for (const std::string& model : options.models)
        job.elastic.push_back(&stage1_fit(elastic, name, model, logs.front().plan.path));
    result.preloads.push_back(fit_preload(std::move(job), elastic));
  }
  return result;
}

}  // namespace cablefit
