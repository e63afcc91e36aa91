#include "cablefit/dynamic/checks/validation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "cablefit/base/error.hpp"
#include "cablefit/dynamic/checks/conditions.hpp"
#include "cablefit/dynamic/checks/noise_floor.hpp"
#include "cablefit/dynamic/checks/residual_tests.hpp"
#include "cablefit/dynamic/rows/requirements.hpp"
#include "cablefit/samples/rows/agreement.hpp"

namespace cablefit {
namespace {

// Of every log: what residual tests need, 0.3 million rows of a log at 1 kHz.
constexpr std::size_t kTestedWindows = 40;

/// Inertia, viscous friction and offset alone, fitted to the same rows.
Eigen::VectorXd smooth_residual(const EquationRows& e) {
  LinearProblem problem;
  problem.response = dynamic_response(e.columns, {}, 0);
  for (std::size_t k = 0; k < e.columns.effects.size(); ++k) {
    if (e.columns.effects[k]->follows == MotionPart::direction) continue;
    problem.regressors.push_back(e.columns.first_effect + static_cast<Eigen::Index>(k));
    problem.names.emplace_back(e.columns.effects[k]->parameters.front().name);
  }
  return solve(*e.rows, problem).residual_combination;
}

/// What the linear model leaves of equation `k`; empty: model `m` is it, or there is none.
Eigen::VectorXd linear_residual(const FittedModels& fitted, std::size_t m, std::size_t k) {
  const DynamicJob& job = fitted.job;
  if (job.rigid) return smooth_residual(fitted.equations[k]);
  if (is_linear(*job.elastic[m])) return {};
  for (std::size_t other = 0; other < job.elastic.size(); ++other)
    if (is_linear(*job.elastic[other])) return fitted.solutions[other][k].residual_combination;
  return {};
}

std::string linear_name(const DynamicJob& job) {
  if (job.rigid) return "without dry friction";
  const bool has = std::any_of(job.elastic.begin(), job.elastic.end(),
                               [](const ElasticFit* fit) { return is_linear(*fit); });
  return has && job.elastic.size() > 1 ? "the linear spring" : "";
}

JudgedModel judged_model(const FittedModels& fitted, std::size_t m, std::size_t k) {
  return {fitted.solutions[m][k].residual_combination,
          dynamic_response(fitted.equations[k].columns, fitted.job.elastic, m),
          linear_residual(fitted, m, k)};
}

double torque_rms(const FittedModels& fitted, std::size_t m, std::size_t k) {
  const EquationRows& e = fitted.equations[k];
  const Eigen::VectorXd torque = dynamic_response(e.columns, fitted.job.elastic, m);
  return (e.rows->r() * torque).norm() /
         std::sqrt(static_cast<double>(std::max<Eigen::Index>(1, e.rows->n_rows())));
}

TestedRows tested(const FittedModels& fitted, const JudgedRows& rows, bool are_fitted,
                  std::size_t m) {
  const DynamicJob& job = fitted.job;
  const double rate = sample_rates(job.logs, job.wanted).lowest;
  return {rows, are_fitted, job.settings.rows.decimate / rate, torque_rms(fitted, m, rows.equation),
          torque_unit(job.rig().axes.of(fitted.equations[rows.equation].columns.place.joint))};
}

JudgedEquation named(const FittedModels& fitted, std::size_t m, std::size_t k) {
  JudgedEquation out;
  out.model = fitted.job.models[m];
  out.equation = fitted.equations[k].equation.name;
  return out;
}

/// Logs with rows of the job's preload, and where they come from.
struct Unseen {
  std::vector<LogSurvey> logs;
  std::vector<JudgedRows> rows;
  std::vector<std::string> names;
  std::vector<Repeat> repeats;
};

/// File names, or paths where two are alike.
std::vector<std::string> names_of(const std::vector<LogSurvey>& logs) {
  std::vector<std::string> names, paths;
  for (const LogSurvey& log : logs) {
    names.push_back(std::filesystem::path(log.plan.path).filename().string());
    paths.push_back(log.plan.path);
  }
  return std::set<std::string>(names.begin(), names.end()).size() == names.size() ? names : paths;
}

Unseen look_at_unseen(const FittedModels& fitted) {
  const DynamicJob& job = fitted.job;
  Unseen unseen;
  for (const LogSurvey& log : job.options.validation) {
    if (std::none_of(log.parts.begin(), log.parts.end(), job.wanted)) continue;
    unseen.logs.push_back(log);
  }
  unseen.names = names_of(unseen.logs);
  if (unseen.logs.empty()) return unseen;
  unseen.rows = judged_rows(job, fitted.equations, unseen.logs, 0);
  unseen.repeats = find_repeats(job, unseen.logs);
  return unseen;
}

/// Repeats that one log is part of.
std::vector<Repeat> repeats_of(const std::vector<Repeat>& repeats, std::size_t log) {
  std::vector<Repeat> own;
  for (const Repeat& repeat : repeats)
    if (repeat.first == log || repeat.second == log) own.push_back(repeat);
  return own;
}

/// The row of one log among the conditions; nullptr: it has no rows.
ConditionError* row_of(JudgedEquation& e, const std::string& log) {
  for (ConditionError& c : e.conditions)
    if (c.condition == "log" && c.value == log) return &c;
  return nullptr;
}

/// Each log has a floor of its own: another log's sensors or repeats say nothing of it.
void add_floors_of_logs(const FittedModels& fitted, const Unseen& unseen,
                        const std::vector<Eigen::VectorXd>& residuals,
                        std::vector<JudgedEquation>& equations) {
  for (std::size_t log = 0; log < unseen.logs.size(); ++log) {
    const std::vector<double> sensors =
        sensor_floor(fitted.job, fitted.equations, {&unseen.logs[log], 1}, residuals);
    const std::vector<Repeat> repeats = repeats_of(unseen.repeats, log);
    for (const JudgedRows& rows : unseen.rows) {
      ConditionError* const row = row_of(equations[rows.equation], unseen.names[log]);
      if (row == nullptr) continue;
      row->floor =
          repeat_floor(rows, repeats, residuals[rows.equation]).value_or(sensors[rows.equation]);
    }
  }
}

/// The floor of every equation for one model: of all logs together, and of each.
void add_floors(const FittedModels& fitted, const Unseen& unseen, std::size_t m,
                std::vector<JudgedEquation>& equations) {
  std::vector<Eigen::VectorXd> residuals;
  for (const LinearSolution& s : fitted.solutions[m]) residuals.push_back(s.residual_combination);
  const std::vector<double> sensors =
      sensor_floor(fitted.job, fitted.equations, unseen.logs, residuals);
  for (const JudgedRows& rows : unseen.rows) {
    JudgedEquation& e = equations[rows.equation];
    const auto repeats = repeat_floor(rows, unseen.repeats, residuals[rows.equation]);
    e.noise_floor = repeats ? *repeats : sensors[rows.equation];
    e.floor_source = repeats ? "repeats" : "sensor noise";
    if (!e.conditions.empty()) e.conditions.front().floor = e.noise_floor;
  }
  add_floors_of_logs(fitted, unseen, residuals, equations);
}

std::vector<JudgedEquation> judged_on(const FittedModels& fitted, const Unseen& unseen,
                                      const std::vector<JudgedRows>& own, std::size_t m) {
  std::vector<JudgedEquation> out;
  auto known = own.begin();
  for (const JudgedRows& rows : unseen.rows) {
    JudgedEquation e = named(fitted, m, rows.equation);
    e.conditions = condition_errors(rows, *known, conditions(rows, *known, unseen.names),
                                    judged_model(fitted, m, rows.equation));
    e.tests = residual_tests(tested(fitted, rows, false, m), fitted.solutions[m][rows.equation], e);
    out.push_back(std::move(e));
    ++known;
  }
  add_floors(fitted, unseen, m, out);
  return out;
}

}  // namespace

void judge(const FittedModels& fitted, DynamicPreload& preload) {
  const DynamicJob& job = fitted.job;
  const bool has_unseen = !job.options.validation.empty();
  if (!job.options.residual_tests && !has_unseen) return;
  const std::vector<JudgedRows> own = judged_rows(job, fitted.equations, job.logs, kTestedWindows);
  for (std::size_t m = 0; m < job.models.size(); ++m)
    for (const JudgedRows& rows : own) {
      preload.residual_tests.push_back(named(fitted, m, rows.equation));
      JudgedEquation& judged = preload.residual_tests.back();
      judged.tests =
          residual_tests(tested(fitted, rows, true, m), fitted.solutions[m][rows.equation], judged);
    }
  const Unseen unseen = look_at_unseen(fitted);
  if (unseen.logs.empty()) return;
  Validation& validation = preload.validation.emplace();
  for (const LogSurvey& log : unseen.logs) validation.logs.push_back(log.plan.path);
  validation.linear_name = linear_name(job);
  for (std::size_t m = 0; m < job.models.size(); ++m)
    for (JudgedEquation& e : judged_on(fitted, unseen, own, m))
      validation.equations.push_back(std::move(e));
}

void require_judgeable(std::span<const LogSurvey> unseen, const std::vector<std::string>& preloads,
                       const LogSurvey& fitted, bool rigid) {
  for (const LogSurvey& log : unseen) {
    const Place place{log.plan.path, 0, 0};
    if (log.plan.rig.n_joints() != fitted.plan.rig.n_joints() ||
        log.plan.rig.axes != fitted.plan.rig.axes)
      throw input_error(place, "another kind of rig than the fitted logs",
                        "validate on logs of the same drive");
    require_channels(log.plan, rigid);
    const bool has_any = std::any_of(log.parts.begin(), log.parts.end(), [&](const auto& part) {
      return part.phase == Phase::moving &&
             std::find(preloads.begin(), preloads.end(), part.preload) != preloads.end();
    });
    if (!has_any)
      throw input_error(
          place, fmt::format("no moving rows of a fitted preload ({})", fmt::join(preloads, ", ")),
          "use the same preload names, or fit a log of this preload");
  }
}

}  // namespace cablefit
