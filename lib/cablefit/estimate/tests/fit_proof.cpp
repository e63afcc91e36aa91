#include "cablefit/estimate/tests/fit_proof.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/estimate/fit/parameter_estimate.hpp"

namespace cablefit {
namespace {

constexpr double kLevel = 0.95;
constexpr double kBiasNoted = 0.5;  // sd; a larger bias above three standard errors is reported
constexpr double kStandardErrors = 3;
// Of the scatter to the mean sd, with its factor. Where the sd is right, 5 runs have this ratio
// with a probability of 1 in 1000.
constexpr double kScatterNoted = 2.2;
constexpr std::size_t kScatterRuns = 5;

bool has_numbers(const Estimate& e) {
  return std::isfinite(e.value) && e.sd > 0 && std::isfinite(e.ci_low) && std::isfinite(e.ci_high);
}

/// |estimate - truth| as a multiple of the interval's half width on that side.
double misses(const Estimate& e, double truth) {
  const double half = truth > e.value ? e.ci_high - e.value : e.value - e.ci_low;
  const double off = std::abs(truth - e.value);
  if (half > 0) return off / half;
  return off > 0 ? kUnbounded : 0;
}

double factor_to_cover(std::vector<double> ratios) {
  std::sort(ratios.begin(), ratios.end());
  const auto n = static_cast<double>(ratios.size());
  const auto wanted = static_cast<std::size_t>(std::ceil(kLevel * (n + 1)));
  const double factor = ratios[std::min(wanted, ratios.size()) - 1];
  return std::isfinite(factor) ? std::max(1.0, factor) : 1;
}

void describe(ProvedParameter& p) {
  if (p.n_runs == 0) {
    p.verdict = "no run determined it";
    return;
  }
  p.verdict = p.coverage_band.high < kLevel  ? fmt::format("too narrow, sd times {:.2f}", p.factor)
              : p.coverage_band.low > kLevel ? "covers, wider than needed"
                                             : "covers";
  const double off = std::abs(p.bias);
  if (off > kBiasNoted * p.mean_sd && off > kStandardErrors * p.standard_error)
    p.verdict += fmt::format("; biased by {:+.1f} sd", p.bias / p.mean_sd);
  if (p.n_runs >= kScatterRuns && p.scatter > kScatterNoted * p.factor * p.mean_sd)
    p.verdict += fmt::format("; scatters by {:.1f} sd", p.scatter / p.mean_sd);
  if (p.n_open > 0)
    p.verdict += fmt::format("; not determined in {} of {} runs", p.n_open, p.n_open + p.n_runs);
}

}  // namespace

ShareBand share_band(std::size_t hits, std::size_t n_trials, double z) {
  const auto n = static_cast<double>(n_trials);
  const double share = static_cast<double>(hits) / n;
  const double middle = (share + z * z / (2 * n)) / (1 + z * z / n);
  const double half =
      z / (1 + z * z / n) * std::sqrt(share * (1 - share) / n + z * z / (4 * n * n));
  return {std::max(0.0, middle - half), std::min(1.0, middle + half)};
}

ProvedParameter judge_runs(const Estimate& truth, std::span<const Estimate> estimates) {
  ProvedParameter p;
  p.name = truth.name;
  p.unit = truth.unit;
  p.truth = truth.value;
  std::vector<double> ratios;
  double sum = 0, squares = 0;
  for (const Estimate& e : estimates) {
    if (!has_numbers(e)) continue;
    const double off = e.value - p.truth;
    sum += off;
    squares += off * off;
    p.mean_sd += e.sd;
    ratios.push_back(misses(e, p.truth));
    p.n_covered += ratios.back() <= 1;
  }
  p.n_runs = ratios.size();
  p.n_open = static_cast<std::size_t>(
      std::count_if(estimates.begin(), estimates.end(),
                    [](const Estimate& e) { return !std::isfinite(e.value); }));
  if (p.n_runs > 0) {
    const auto n = static_cast<double>(p.n_runs);
    p.bias = sum / n;
    p.mean_sd /= n;
    if (p.n_runs > 1) p.scatter = std::sqrt(std::max(0.0, squares - n * p.bias * p.bias) / (n - 1));
    p.standard_error = p.scatter / std::sqrt(n);
    p.coverage_band = share_band(p.n_covered, p.n_runs);
    if (p.coverage_band.high < kLevel) p.factor = factor_to_cover(ratios);
  }
  describe(p);
  return p;
}

void widen(std::vector<Estimate>& estimates, const FitProof& proof) {
  for (const ProvedParameter& p : proof.parameters) {
    if (!(p.factor > 1)) continue;
    for (Estimate& e : estimates)
      if (e.name == p.name && has_numbers(e)) widen_interval(e, p.factor);
  }
}

}  // namespace cablefit
