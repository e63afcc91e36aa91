#include "cablefit/prove/proof_runs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "cablefit/base/parallel.hpp"

namespace cablefit {
namespace {

std::string verdict_of(const FitProof& proof) {
  const bool any = std::any_of(proof.parameters.begin(), proof.parameters.end(),
                               [](const ProvedParameter& p) { return p.n_runs > 0; });
  if (!any) return "not proved: no run ended with estimates";
  std::vector<std::string> narrow, biased, scattered, open;
  for (const ProvedParameter& p : proof.parameters) {
    if (p.factor > 1) narrow.push_back(p.name);
    if (p.verdict.find("biased") != std::string::npos) biased.push_back(p.name);
    if (p.verdict.find("scatters") != std::string::npos) scattered.push_back(p.name);
    if (p.n_open > p.n_runs) open.push_back(p.name);
  }
  std::string text = narrow.empty()
                         ? "the 95 % intervals contain the true values"
                         : fmt::format("the intervals of {} are too narrow and were widened",
                                       fmt::join(narrow, ", "));
  if (!biased.empty())
    text += fmt::format("; {} wrong by more than half an sd on average", fmt::join(biased, ", "));
  if (!scattered.empty())
    text +=
        fmt::format("; the scatter of {} is more than twice the sd", fmt::join(scattered, ", "));
  if (!open.empty()) text += fmt::format("; most runs do not determine {}", fmt::join(open, ", "));
  return text;
}

}  // namespace

FitProof prove_by_runs(const std::vector<Estimate>& truth, const ProveOptions& options,
                       std::vector<std::string> notes,
                       const std::function<ProofRun(std::uint64_t seed)>& run) {
  FitProof proof;
  proof.n_runs = options.n_runs;
  proof.seed = options.seed;
  proof.notes = std::move(notes);
  std::vector<ProofRun> runs;
  ordered_pipeline<std::uint64_t>(
      options.threads,
      [&](auto emit) {
        for (std::size_t k = 0; k < options.n_runs; ++k) emit(std::uint64_t{options.seed + k});
      },
      [&](std::uint64_t seed) { return run(seed); },
      [&](ProofRun one) {
        runs.push_back(std::move(one));
        if (options.progress) options.progress(runs.size(), options.n_runs);
      });
  for (const ProofRun& one : runs) {
    if (one.failure.empty()) continue;
    if (proof.n_failed++ == 0) proof.first_failure = one.failure;
  }
  std::vector<std::string> undetermined;
  for (const Estimate& e : truth) {
    if (!e.not_identifiable.empty()) undetermined.push_back(e.name);
    if (!e.not_identifiable.empty() || !(e.sd > 0)) continue;
    std::vector<Estimate> found;
    for (const ProofRun& one : runs) {
      const Estimate* same = find_estimate(one.parameters, e.name);
      if (one.failure.empty()) found.push_back(same != nullptr ? *same : Estimate{});
    }
    proof.parameters.push_back(judge_runs(e, found));
  }
  if (!undetermined.empty())
    proof.notes.push_back(
        fmt::format("not tested: {} (not determined by the fit)", fmt::join(undetermined, ", ")));
  proof.verdict =
      proof.parameters.empty() ? "not proved: the fit determines no parameter" : verdict_of(proof);
  return proof;
}

}  // namespace cablefit
