// Judging intervals by many runs.
#include "cablefit/estimate/tests/fit_proof.hpp"

#include <catch2/catch.hpp>

#include "cablefit/base/random.hpp"

namespace {

using namespace cablefit;

Estimate truth_of(double value) {
  Estimate e;
  e.name = "J";
  e.value = value;
  return e;
}

/// Normal estimates about `mean` with sd 1 that claim `claimed`.
std::vector<Estimate> runs(std::size_t n, double mean, double claimed, std::uint64_t seed = 1) {
  Random random(seed);
  std::vector<Estimate> all;
  for (std::size_t k = 0; k < n; ++k) {
    Estimate e = truth_of(mean + random.normal());
    e.sd = claimed;
    e.ci_low = e.value - 1.959964 * claimed;
    e.ci_high = e.value + 1.959964 * claimed;
    all.push_back(e);
  }
  return all;
}

// Newcombe 1998, "Two-sided confidence intervals for the single proportion", Statist. Med. 17,
// table I, method 3 (Wilson score), printed with four decimals.
TEST_CASE("the band of a share is Wilson's") {
  const auto check = [](std::size_t hits, std::size_t n, double low, double high) {
    const ShareBand band = share_band(hits, n);
    CHECK(band.low == Approx(low).margin(5e-5));
    CHECK(band.high == Approx(high).margin(5e-5));
  };
  check(81, 263, 0.2553, 0.3662);
  check(15, 148, 0.0624, 0.1605);
  check(0, 20, 0.0, 0.1611);
  check(1, 29, 0.0061, 0.1718);
}

TEST_CASE("intervals of the right width cover") {
  const ProvedParameter p = judge_runs(truth_of(5), runs(400, 5, 1));
  CHECK(p.n_runs == 400);
  CHECK(p.verdict == "covers");
  CHECK(p.factor == 1);
  // The scatter of 400 runs is known to 1 / sqrt(800) = 3.5 %, the mean to 5 % of an sd: 3.3 each.
  CHECK(std::abs(p.scatter - 1) < 0.12);
  CHECK(std::abs(p.bias) < 0.17);
}

TEST_CASE("intervals of half the width are widened twice") {
  std::vector<Estimate> narrow = runs(400, 5, 0.5);
  const ProvedParameter p = judge_runs(truth_of(5), narrow);
  // 2 Phi(0.98) - 1 = 0.673.
  CHECK(std::abs(p.coverage() - 0.673) < 3.3 * std::sqrt(0.673 * 0.327 / 400));
  // The 95 % quantile of |z| / (1.96 / 2) is 2; that of 400 runs has an sd of
  // sqrt(0.95 0.05 / 400) / (2 phi(1.96)) / 0.98 = 0.095.
  CHECK(std::abs(p.factor - 2) < 3.3 * 0.095);
  CHECK(p.verdict.starts_with("too narrow, sd times "));
  FitProof proof;
  proof.parameters = {p};
  const Estimate before = narrow.front();
  widen(narrow, proof);
  CHECK(narrow.front().sd == p.factor * before.sd);
  CHECK(narrow.front().ci_high - before.value ==
        Approx(p.factor * (before.ci_high - before.value)));
  CHECK(narrow.front().ci_low == Approx(before.value - p.factor * (before.value - before.ci_low)));
  // Widened intervals of other runs cover.
  std::vector<Estimate> others = runs(400, 5, 0.5, 2);
  widen(others, proof);
  CHECK(judge_runs(truth_of(5), others).verdict == "covers");
}

TEST_CASE("an interval that ends at its bound grows upwards") {
  Estimate e = truth_of(0);
  e.sd = 1;
  e.ci_low = 0;
  e.ci_high = 2;
  e.active_bound = "J >= 0";
  FitProof proof;
  proof.parameters.emplace_back();
  proof.parameters.back().name = "J";
  proof.parameters.back().factor = 3;
  std::vector<Estimate> one = {e};
  widen(one, proof);
  CHECK(one.front().ci_low == 0);
  CHECK(one.front().ci_high == 6);
}

TEST_CASE("a bias is told in sd") {
  const ProvedParameter p = judge_runs(truth_of(5), runs(400, 6, 2));
  CHECK(p.bias == Approx(1).margin(0.17));
  CHECK(p.verdict.find("; biased by +0.5 sd") == std::string::npos);  // 0.5 +- 0.025 is no more
  const ProvedParameter q = judge_runs(truth_of(5), runs(400, 7, 2));
  CHECK(q.verdict.find("; biased by +1.0 sd") != std::string::npos);
}

TEST_CASE("an sd far below the scatter is reported, though the intervals cover") {
  std::vector<Estimate> runs_of_one_degree = runs(200, 5, 0.1);
  for (Estimate& e : runs_of_one_degree) {  // t of one degree of freedom
    e.ci_low = e.value - 12.7 * 0.2;
    e.ci_high = e.value + 12.7 * 0.2;
  }
  const ProvedParameter p = judge_runs(truth_of(5), runs_of_one_degree);
  CHECK(p.factor == 1);
  CHECK(p.verdict.find("; scatters by ") != std::string::npos);
  CHECK(p.scatter / p.mean_sd == Approx(10).margin(1.7));
}

TEST_CASE("runs without a number are not counted") {
  std::vector<Estimate> some = runs(30, 5, 1);
  some[3] = truth_of(std::nan(""));
  const ProvedParameter p = judge_runs(truth_of(5), some);
  CHECK(p.n_runs == 29);
  CHECK(p.n_open == 1);
  CHECK(p.verdict.ends_with("; not determined in 1 of 30 runs"));
  CHECK(judge_runs(truth_of(5), {}).verdict == "no run determined it");
}

}  // namespace
