// Linear least squares on the rows as collected: each equation alone, or the links of an arm, which
// share parameters, stacked.
#include "cablefit/dynamic/estimates/estimates.hpp"
#include "cablefit/dynamic/estimates/joint_estimates.hpp"
#include "cablefit/dynamic/estimators/least_squares_fit.hpp"
#include "cablefit/dynamic/estimators/rows.hpp"
#include "cablefit/estimate/fit/profile_interval.hpp"

namespace cablefit::estimation {

std::string reason_for_sd(const EstimationTask& task, const RowStatistics& rows,
                          const DynamicColumns& columns, const LinearSolution& solution) {
  const DynamicJob& job = task.job;
  if (!job.options.robust_sd) return "white: as asked for, the paper's (25)";
  return sd_reason(rows, columns, solution, job.settings.rows.decimate * job.first_part().period);
}

Estimation least_squares_fit(const EstimationTask& task, Weighting weighting) {
  const DynamicJob& job = task.job;
  Estimation out;
  out.solutions.resize(task.equations.size());
  std::vector<EquationInfluence> influences;
  for (const std::vector<std::size_t>& system : systems_of(task.equations)) {
    const EquationRows& first = task.equations[system.front()];
    const SystemRows system_rows(task.equations, system, job.elastic, task.model, weighting);
    const RowStatistics& rows = system_rows.get();
    const LinearProblem problem = problem_of(first.columns, job.elastic, task.model);
    LinearSolution solution = solve(rows, problem);
    solution.profile = profile_intervals(rows, problem, solution, job.options.robust_sd);
    add_estimates(rows, first.columns, solution, task.stage1(), task.model, job.options.robust_sd,
                  out.fit);
    influences.push_back(influence_of(rows, first.columns, solution, task.stage1(), task.model));
    const std::string reason = reason_for_sd(task, rows, first.columns, solution);
    for (const std::size_t k : system) {
      add_errors(*task.equations[k].rows, task.equations[k].equation.name, solution, out.fit);
      out.fit.sd_reason[task.equations[k].equation.name] = reason;
      out.solutions[k] = solution;
    }
  }
  out.joint = join_estimates(out.fit, influences, task.stage1());
  return out;
}

namespace {

Estimation ordinary(const EstimationTask& task) { return least_squares_fit(task, Weighting::none); }
Estimation weighted(const EstimationTask& task) {
  return least_squares_fit(task, Weighting::by_residual);
}

}  // namespace

Estimator ols() {
  return {"ols", "ordinary least squares by streamed QR, all equations of weight one",
          "Golub & Van Loan 2013, ch. 5", ordinary};
}

Estimator wls() {
  return {"wls", "each equation weighted by 1/variance of its own residual", "Gautier 1997",
          weighted};
}

}  // namespace cablefit::estimation
