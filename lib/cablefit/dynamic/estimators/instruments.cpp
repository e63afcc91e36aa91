// Instrumental variables, always (`iv`) or where least squares fails its test (`auto`).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "cablefit/dynamic/estimates/estimates.hpp"
#include "cablefit/dynamic/estimates/joint_estimates.hpp"
#include "cablefit/dynamic/estimators/instrument_proof.hpp"
#include "cablefit/dynamic/estimators/least_squares_fit.hpp"
#include "cablefit/dynamic/estimators/rows.hpp"
#include "cablefit/dynamic/loops/instrumental_variables.hpp"
#include "cablefit/estimate/fit/instruments.hpp"
#include "cablefit/estimate/fit/profile_interval.hpp"
#include "cablefit/model/file/controller_text.hpp"

namespace cablefit::estimation {
namespace {

constexpr double kSignificant = 0.05;

/// "link 9432 rows, motor 5573": not those of least squares.
std::string rows_of(const EstimationTask& task, const IvFit& fit) {
  std::string text;
  for (std::size_t k = 0; k < task.equations.size(); ++k)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", task.equations[k].equation.name,
                        fit.counts[k].rows_used);
  return text;
}

/// What became of the controller; a found one as it is written in a rig file.
void note_controller(const EstimationTask& task, const LoopPlan& plan, Estimation& out) {
  out.fit.warnings.insert(out.fit.warnings.end(), plan.warnings.begin(), plan.warnings.end());
  if (!plan.fitted) return;
  out.decisions.push_back({task.decision_name("controller"), "found from the logs",
                           plan.fitted->text(task.job.rig().axes) +
                               "; in the rig file: " + controller_text(plan.fitted->controller())});
}

void note_instruments(const EstimationTask& task, const LoopPlan& plan, const IvFit& fit,
                      Estimation& out) {
  out.decisions.push_back(
      {task.decision_name("instruments"),
       fmt::format("{} simulation{}", fit.n_simulations, fit.n_simulations == 1 ? "" : "s"),
       fmt::format("{}; rows by {} rest: {}", source_of_instruments(plan),
                   keeps_disturbances_out(plan.kind) ? "its" : "its and the drive's",
                   rows_of(task, fit))});
  if (!fit.converged())
    out.fit.doubts.push_back(
        fmt::format("the instruments did not converge in {} simulations: the last one changed an "
                    "estimate by {:.2g} sd",
                    fit.n_simulations, fit.last_change));
}

/// What is solved together, and the first equation of it, whose columns are those of all.
struct System {
  std::vector<std::size_t> equations;
  const EquationRows* first = nullptr;
  std::string name;  ///< "motor", "link[1] + link[2]"
};

std::vector<System> systems_of(const EstimationTask& task) {
  std::vector<System> systems;
  for (const std::vector<std::size_t>& equations : cablefit::systems_of(task.equations)) {
    System& system = systems.emplace_back();
    system.equations = equations;
    system.first = &task.equations[equations.front()];
    for (const std::size_t k : equations)
      system.name += (system.name.empty() ? "" : " + ") + task.equations[k].equation.name;
  }
  return systems;
}

SystemRows plain_rows(const EstimationTask& task, const System& system) {
  return {task.equations, system.equations, task.job.elastic, task.model, Weighting::by_residual};
}

/// Per system.
std::vector<LinearSolution> least_squares_of(const EstimationTask& task) {
  std::vector<LinearSolution> solutions;
  for (const System& system : systems_of(task))
    solutions.push_back(solve_rows(plain_rows(task, system).get(), system.first->columns,
                                   task.job.elastic, task.model));
  return solutions;
}

/// On the stretches alone; the difference of two fits to the same rows does not scatter with them.
std::vector<LinearSolution> least_squares_on(const TestRows& test, const EstimationTask& task) {
  DynamicJob job = task.job;
  job.logs = test.logs(task.job);
  std::vector<EquationRows> equations = make_equations(job);
  collect_rows(job, equations);
  return least_squares_of({job, equations, task.model});
}

void add_system(const EstimationTask& task, const System& system, const RowStatistics& rows,
                LinearSolution solution, std::vector<EquationInfluence>& influences,
                Estimation& out) {
  const EquationRows& e = *system.first;
  const LinearProblem problem = solution.instruments.empty()
                                    ? problem_of(e.columns, task.job.elastic, task.model)
                                    : instrumented_problem(task.job, e, task.model);
  solution.profile = profile_intervals(rows, problem, solution, task.job.options.robust_sd);
  add_estimates(rows, e.columns, solution, task.stage1(), task.model, task.job.options.robust_sd,
                out.fit);
  influences.push_back(influence_of(rows, e.columns, solution, task.stage1(), task.model));
  const std::string reason = reason_for_sd(task, rows, e.columns, solution);
  LinearSolution own =
      std::move(solution);  // without the instruments' columns, which it does not use
  own.residual_combination = own.residual_combination.head(e.columns.count).eval();
  out.solutions.resize(task.equations.size());
  for (const std::size_t k : system.equations) {
    const std::string& name = task.equations[k].equation.name;
    out.fit.sd_reason[name] = reason;
    add_errors(*task.equations[k].rows, name, own, out.fit);
    out.solutions[k] = own;
  }
}

bool is_rejected(const ExogeneityTest& test) {
  return test.possible && test.p_value < kSignificant;
}

/// The common result of the test and the two fits of one system.
struct Judgement {
  ExogeneityTest test;
  EstimateDifference difference;
  std::string name;  ///< of the parameter that differs most

  bool wants_instruments() const {
    return is_rejected(test) && judge_difference(difference) != Difference::none;
  }
};

Judgement judge(const EquationRows& e, const LinearSolution& plain, const LinearSolution& with,
                const ExogeneityTest& test) {
  Judgement j{test, largest_difference(plain, with), ""};
  if (j.difference.parameter >= 0)
    j.name = e.columns.parameters[static_cast<std::size_t>(j.difference.parameter)].name;
  return j;
}

std::vector<Judgement> judge_all(const EstimationTask& task,
                                 const std::vector<LinearSolution>& plain, const IvFit& fit) {
  std::vector<Judgement> all;
  for (const System& system : systems_of(task)) {
    const std::size_t k = all.size();
    all.push_back(judge(*system.first, plain[k], fit.solutions[k], fit.tests[k]));
  }
  return all;
}

/// "J_link differs most, by -0.31 sd or -0.02 %". `stands`, `used`: what becomes of least squares.
std::string verdict(const Judgement& j, const char* stands, const char* used) {
  if (!j.test.possible) return "not tested: no instrument differs from its regressor";
  const std::string p = j.test.p_text();
  if (!is_rejected(j.test)) return fmt::format("regressors are exogenous: {} ({})", stands, p);
  if (j.name.empty()) return fmt::format("correlated with the residual ({}): {}", p, used);
  std::string difference =
      fmt::format("{} differs most, by {:+.2g} sd", j.name, j.difference.in_sd);
  if (std::isfinite(j.difference.relative))  // of an estimate that is not 0
    difference += fmt::format(" or {:+.2g} %", 100 * j.difference.relative);
  switch (judge_difference(j.difference)) {
    case Difference::none:
      return fmt::format("correlated with the residual ({}), but that does not matter: {}: {}", p,
                         difference, stands);
    case Difference::small:
      return fmt::format(
          "correlated with the residual ({}), a little: {}, more than intervals allow: {}", p,
          difference, used);
    case Difference::material:
      break;
  }
  return fmt::format("correlated with the residual ({}): {}: {}", p, difference, used);
}

std::string verdict_key(const EquationRows& e) { return e.equation.name + " equation"; }

void set_verdict(const EstimationTask& task, const System& system, const std::string& text,
                 Estimation& out) {
  for (const std::size_t k : system.equations)
    out.fit.verdicts[verdict_key(task.equations[k])] = text;
}

/// Least squares, because nothing could be simulated.
Estimation stay_with_least_squares(const EstimationTask& task, const std::string& why) {
  Estimation out = least_squares_fit(task, Weighting::by_residual);
  out.fit.estimator = "wls";
  out.decisions.push_back({task.decision_name("estimator"), "wls", "no instruments: " + why});
  for (const EquationRows& e : task.equations)
    out.fit.verdicts[verdict_key(e)] = "not tested, no instruments: " + why;
  return out;
}

bool any_weak(const IvFit& fit) {
  return std::any_of(fit.solutions.begin(), fit.solutions.end(), has_weak_instruments);
}

/// By the planned loop. Where a found controller gives weak instruments or none, by a surrogate.
/// `plan` becomes the plan that was used.
IvFit fit_by_loop(const EstimationTask& task, std::span<const LogSurvey> logs,
                  const std::vector<LinearSolution>& plain, LoopPlan& plan) {
  IvFit fit = fit_by_instruments(task.job, logs, task.equations, plain, task.model, plan);
  if (!plan.fitted || (fit.failure.empty() && !any_weak(fit))) return fit;
  plan = without_found_controller(std::move(plan));
  return fit_by_instruments(task.job, logs, task.equations, plain, task.model, plan);
}

Estimation estimate_iv(const EstimationTask& task) {
  const DynamicJob& job = task.job;
  LoopPlan plan = plan_loop(job, job.logs);
  if (plan.kind == LoopKind::none) return stay_with_least_squares(task, plan.reason);
  const std::vector<LinearSolution> plain = least_squares_of(task);
  const IvFit fit = fit_by_loop(task, job.logs, plain, plan);
  if (!fit.failure.empty()) return stay_with_least_squares(task, fit.failure);
  Estimation out;
  std::vector<EquationInfluence> influences;
  const std::vector<Judgement> judgements = judge_all(task, plain, fit);
  const std::vector<System> systems = systems_of(task);
  for (std::size_t k = 0; k < systems.size(); ++k) {
    add_system(task, systems[k], fit.rows[k], fit.solutions[k], influences, out);
    set_verdict(task, systems[k],
                verdict(judgements[k], "wls would be sufficient", "the iv estimates are used"),
                out);
  }
  out.joint = join_estimates(out.fit, influences, task.stage1());
  note_controller(task, plan, out);
  note_instruments(task, plan, fit, out);
  return out;
}

/// "motor p = 0.4, link p < 0.001"
std::string all_p(const EstimationTask& task, const std::vector<Judgement>& judgements) {
  std::string text;
  const std::vector<System> systems = systems_of(task);
  for (std::size_t k = 0; k < systems.size(); ++k)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", systems[k].name,
                        judgements[k].test.possible ? judgements[k].test.p_text() : "not tested");
  return text;
}

bool any_wants(const std::vector<Judgement>& judgements) {
  return std::any_of(judgements.begin(), judgements.end(),
                     [](const Judgement& j) { return j.wants_instruments(); });
}

/// Least squares stands, but what instruments would change is part of its sd. `plain` and `with`
/// are of the same rows.
void keep_difference(const EquationRows& e, const LinearSolution& plain, const LinearSolution& with,
                     DynamicFit& fit) {
  for (Eigen::Index k = 0; k < e.columns.n_effects; ++k) {
    const auto at = static_cast<std::size_t>(k);
    if (plain.not_identifiable[at].empty() && with.not_identifiable[at].empty())
      fit.estimator_difference[e.columns.parameters[at].name] = std::abs(with.x(k) - plain.x(k));
  }
}

/// Which systems use instruments, and why.
struct Decided {
  std::vector<Judgement> judgements;
  std::vector<InstrumentProof> proofs;  ///< empty: none is needed
  std::vector<bool> uses;

  bool any_uses() const { return std::find(uses.begin(), uses.end(), true) != uses.end(); }
};

/// Of each system: as it wants, and where a surrogate makes the instruments, as it is proved.
Decided decide(const EstimationTask& task, const LoopPlan& plan, const TestRows& test,
               const std::vector<LinearSolution>& plain, const IvFit& fit) {
  Decided decided{judge_all(task, plain, fit), {}, {}};
  if (any_wants(decided.judgements) && !keeps_disturbances_out(plan.kind))
    decided.proofs = prove_instruments(task, test, fit);
  for (std::size_t k = 0; k < decided.judgements.size(); ++k)
    decided.uses.push_back(decided.judgements[k].wants_instruments() &&
                           (decided.proofs.empty() || decided.proofs[k].holds()));
  return decided;
}

Estimation estimate_automatically(const EstimationTask& task) {
  const DynamicJob& job = task.job;
  const TestRows test = rows_for_test(job);
  LoopPlan plan = plan_loop(job, test.logs(job));
  if (plan.kind == LoopKind::none) return stay_with_least_squares(task, plan.reason);
  const std::vector<LinearSolution> plain = least_squares_of(task);
  IvFit fit = fit_by_loop(task, test.logs(job), plain, plan);
  if (!fit.failure.empty()) return stay_with_least_squares(task, fit.failure);
  if (any_weak(fit))
    return stay_with_least_squares(task,
                                   "the simulated loop does not reproduce the measured motion");
  Decided decided = decide(task, plan, test, plain, fit);
  bool of_stretches = !test.stretches.empty();
  if (of_stretches && decided.any_uses()) {
    // Settled and confirmed on the stretches; the same once more with all rows, whose differences
    // count. What few rows do not confirm, more rows would not: their sd is smaller.
    IvFit all =
        fit_by_instruments(job, job.logs, task.equations, fit.solutions, task.model, plan, 1);
    if (!all.failure.empty()) return stay_with_least_squares(task, all.failure);
    all.n_simulations += fit.n_simulations;
    all.last_change = fit.last_change;
    all.tests = std::move(fit.tests);
    fit = std::move(all);
    of_stretches = false;
    decided = decide(task, plan, test, plain, fit);
  }
  const std::vector<Judgement>& judgements = decided.judgements;
  const std::vector<LinearSolution> beside =
      of_stretches && any_wants(judgements) ? least_squares_on(test, task) : plain;
  Estimation out;
  out.fit.estimator = decided.any_uses() ? "iv" : "wls";
  out.decisions.push_back(
      {task.decision_name("estimator"), out.fit.estimator,
       fmt::format("Durbin-Wu-Hausman: {}{}", all_p(task, judgements), test.note)});
  std::vector<EquationInfluence> influences;
  const std::vector<System> systems = systems_of(task);
  for (std::size_t k = 0; k < systems.size(); ++k) {
    std::string text = verdict(judgements[k], "wls is kept", "the iv estimates are used");
    if (decided.uses[k]) {
      add_system(task, systems[k], fit.rows[k], fit.solutions[k], influences, out);
    } else {
      add_system(task, systems[k], plain_rows(task, systems[k]).get(), plain[k], influences, out);
      if (judgements[k].wants_instruments()) {
        keep_difference(*systems[k].first, beside[k], fit.solutions[k], out.fit);
        text = verdict(judgements[k], "", "wls is kept, with the difference in its sd") +
               " (instruments not confirmed: " + decided.proofs[k].text() + ")";
      }
    }
    set_verdict(task, systems[k], text, out);
  }
  out.joint = join_estimates(out.fit, influences, task.stage1());
  note_controller(task, plan, out);
  note_instruments(task, plan, fit, out);
  return out;
}

}  // namespace

Estimator iv() {
  return {"iv",
          "instrumental variables from a simulated noise-free closed loop, iterated (IDIM-IV)",
          "Janot, Vandanjon & Gautier 2014", estimate_iv};
}

Estimator automatic() {
  return {"auto",
          "wls, and iv for each equation (of an arm, all its links together) that fails the "
          "Durbin-Wu-Hausman test, if instruments are confirmed",
          "Janot et al. 2016", estimate_automatically};
}

}  // namespace cablefit::estimation
