#include "cablefit/dynamic/loops/instrumental_variables.hpp"

#include <algorithm>

#include "cablefit/dynamic/loops/model_of_solutions.hpp"
#include "cablefit/estimate/tests/exogeneity.hpp"

namespace cablefit {
namespace {

constexpr double kStill = 0.05;  // of an sd: what another simulation would move

/// Simulates with `before` and fits; the new solutions are in `fit`.
void simulate_and_fit(const DynamicJob& job, std::span<const LogSurvey> logs,
                      const std::vector<EquationRows>& equations,
                      const std::vector<LinearSolution>& before, std::size_t which,
                      const LoopPlan& plan, IvFit& fit) {
  const Model model = model_of_solutions(job, equations, before, which);
  const SimulatedLogs simulated = simulate_loops(job, logs, model, plan);
  ++fit.n_simulations;
  fit.failure = simulated.failure;
  if (!fit.failure.empty()) return;
  fit.rows = collect_instrumented(job, simulated.logs, equations, plan.kind);
  fit.solutions.clear();
  fit.last_change = 0;
  for (std::size_t k = 0; k < equations.size(); ++k) {
    fit.solutions.push_back(
        solve(fit.rows[k].rows, instrumented_problem(job, equations[k], which)));
    fit.last_change = std::max(fit.last_change, largest_change_in_sd(before[k], fit.solutions[k]));
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
  for (std::size_t k = 0; k < equations.size(); ++k)
    fit.tests.push_back(
        test_exogeneity(fit.rows[k].rows, instrumented_problem(job, equations[k], which)));
  return fit;
}

}  // namespace cablefit
