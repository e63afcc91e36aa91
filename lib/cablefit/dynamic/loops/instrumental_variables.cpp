#include "cablefit/dynamic/loops/instrumental_variables.hpp"

#include <algorithm>

#include "cablefit/dynamic/loops/model_of_solutions.hpp"
#include "cablefit/estimate/tests/exogeneity.hpp"

namespace cablefit {
namespace {

constexpr double kStill = 0.05;  // of an sd: what another simulation would move

std::vector<LinearSolution> per_equation(const std::vector<std::vector<std::size_t>>& systems,
                                         const std::vector<LinearSolution>& solutions) {
  std::size_t n = 0;
  for (const std::vector<std::size_t>& system : systems) n += system.size();
  std::vector<LinearSolution> all(n);
  for (std::size_t s = 0; s < systems.size(); ++s)
    for (const std::size_t k : systems[s]) all[k] = solutions[s];
  return all;
}

/// The rows of a system, those of several equations weighted by 1/variance of their residual in
/// least squares without instruments.
RowStatistics joined_rows(const DynamicJob& job, const std::vector<EquationRows>& equations,
                          const std::vector<std::size_t>& system, std::size_t which,
                          std::vector<InstrumentedRows>& rows) {
  if (system.size() == 1) return std::move(rows[system.front()].rows);
  std::vector<const RowStatistics*> parts;
  std::vector<double> weights;
  for (const std::size_t k : system) {
    LinearProblem plain = instrumented_problem(job, equations[k], which);
    plain.instruments.clear();
    parts.push_back(&rows[k].rows);
    weights.push_back(residual_weight(rows[k].rows, plain));
  }
  return RowStatistics::weighted(parts, weights);
}

/// Simulates with `before` and fits; the new solutions are in `fit`.
void simulate_and_fit(const DynamicJob& job, std::span<const LogSurvey> logs,
                      const std::vector<EquationRows>& equations,
                      const std::vector<LinearSolution>& before, std::size_t which,
                      const LoopPlan& plan, IvFit& fit) {
  const std::vector<std::vector<std::size_t>> systems = systems_of(equations);
  const Model model = model_of_solutions(job, equations, per_equation(systems, before), which);
  const SimulatedLogs simulated = simulate_loops(job, logs, model, plan);
  ++fit.n_simulations;
  fit.failure = simulated.failure;
  if (!fit.failure.empty()) return;
  std::vector<InstrumentedRows> rows =
      collect_instrumented(job, simulated.logs, equations, plan.kind);
  fit.counts.clear();
  for (const InstrumentedRows& one : rows) fit.counts.push_back(one.counts);
  fit.rows.clear();
  fit.solutions.clear();
  fit.last_change = 0;
  for (std::size_t s = 0; s < systems.size(); ++s) {
    fit.rows.push_back(joined_rows(job, equations, systems[s], which, rows));
    fit.solutions.push_back(
        solve(fit.rows[s], instrumented_problem(job, equations[systems[s].front()], which)));
    fit.last_change = std::max(fit.last_change, largest_change_in_sd(before[s], fit.solutions[s]));
  }
}

}  // namespace

bool IvFit::converged() const { return failure.empty() && last_change < kStill; }

IvFit fit_by_instruments(const DynamicJob& job, std::span<const LogSurvey> logs,
                         const std::vector<EquationRows>& equations,
                         const std::vector<LinearSolution>& start, std::size_t which,
                         const LoopPlan& plan, int most_simulations) {
  IvFit fit;
  std::vector<LinearSolution> before = start;
  while (fit.n_simulations < most_simulations) {
    simulate_and_fit(job, logs, equations, before, which, plan, fit);
    if (!fit.failure.empty()) return fit;
    // A model from weak instruments is not worth a simulation.
    if (fit.converged() ||
        std::any_of(fit.solutions.begin(), fit.solutions.end(), has_weak_instruments))
      break;
    before = fit.solutions;
  }
  const std::vector<std::vector<std::size_t>> systems = systems_of(equations);
  for (std::size_t s = 0; s < systems.size(); ++s)
    fit.tests.push_back(test_exogeneity(
        fit.rows[s], instrumented_problem(job, equations[systems[s].front()], which)));
  return fit;
}

}  // namespace cablefit
