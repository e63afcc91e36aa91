#include "cablefit/dynamic/estimators/instrument_proof.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/dynamic/loops/log_copy.hpp"
#include "cablefit/dynamic/rows/scaled_settings.hpp"
#include "cablefit/estimate/tests/held_out_moments.hpp"
#include "cablefit/samples/rows/agreement.hpp"

namespace cablefit {
namespace {

// `auto` looks at this many rows of longer logs before it decides. A bias that shows in fewer rows
// than that matters, one that does not is below the sd of the fit to them.
constexpr double kRowsForTest = 250000;

constexpr double kNearCutoffs[] = {0.71, 1.41};
constexpr double kAgreement = 1;  // sd

}  // namespace

TestRows rows_for_test(const DynamicJob& job) {
  TestRows rows;
  double all = 0;
  for (const LogSurvey& log : job.logs)
    for (const PartSurvey& part : log.parts)
      if (job.wanted(part)) all += static_cast<double>(part.n_rows);
  if (all <= kRowsForTest) return rows;
  const double share = kRowsForTest / all;
  rows.stretches =
      stretches_of(job.logs, job.wanted, share, bridge_seconds(job.settings.rows.signal));
  rows.note =
      fmt::format(", judged on {:.2g} % of the rows in evenly spaced stretches", 100 * share);
  return rows;
}

std::string InstrumentProof::text() const {
  return fmt::format("{} changes by {:.2g} sd between cut-offs; {} than wls on held-out blocks",
                     parameter, moved, better ? "better" : "not better");
}

std::vector<InstrumentProof> prove_instruments(const EstimationTask& task, const TestRows& test,
                                               const IvFit& fit) {
  const DynamicJob& job = task.job;
  const std::vector<std::vector<std::size_t>> systems = systems_of(task.equations);
  const auto first_of = [&](std::size_t k) -> const EquationRows& {
    return task.equations[systems[k].front()];
  };
  std::vector<InstrumentProof> proofs(systems.size());
  for (std::size_t k = 0; k < proofs.size(); ++k) {
    const HeldOutMoments moments =
        held_out_moments(fit.rows[k], instrumented_problem(job, first_of(k), task.model));
    proofs[k].better = moments.with < moments.plain;
  }
  const double rate = sample_rates(job.logs, job.wanted).lowest;
  int n_cutoffs = 0;
  for (const double factor : kNearCutoffs) {
    if (factor * job.settings.rows.signal.cutoff > kMostShareOfRate * rate) continue;
    const DynamicJob other = with_cutoff_scaled(job, factor);
    const std::vector<EquationRows> equations = make_equations(other);
    const std::span<const LogSurvey> logs = test.logs(job);
    const IvFit again = fit_by_instruments(other, logs, equations, fit.solutions, task.model,
                                           plan_loop(other, logs), 1);
    if (!again.failure.empty()) return proofs;
    ++n_cutoffs;
    for (std::size_t k = 0; k < proofs.size(); ++k) {
      const EstimateDifference moved = largest_difference(fit.solutions[k], again.solutions[k]);
      if (moved.parameter < 0 || std::abs(moved.in_sd) < proofs[k].moved) continue;
      proofs[k].moved = std::abs(moved.in_sd);
      proofs[k].parameter =
          first_of(k).columns.parameters[static_cast<std::size_t>(moved.parameter)].name;
    }
  }
  for (InstrumentProof& proof : proofs) proof.agrees = n_cutoffs > 0 && proof.moved < kAgreement;
  return proofs;
}

}  // namespace cablefit
