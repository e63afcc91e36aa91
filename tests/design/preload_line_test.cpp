// Lines through estimates of several preloads: closed forms, and bands that hold the truth.
#include "cablefit/design/curves/preload_line.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <vector>

#include "tests/support/monte_carlo.hpp"
#include "tests/truth/parts.hpp"

namespace {

using namespace cablefit;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

constexpr double kExact = 1e-10;

PreloadEstimate at(double x, double y, double sd) { return {x, y, 0, sd * sd, 0}; }

// Through (0, 1) and (10, 3): at x the shares are 1 - x / 10 and x / 10.
TEST_CASE("two preloads make a line as sure as their sd", "[design]") {
  const std::vector<PreloadEstimate> two = {at(0, 1, 0.3), at(10, 3, 0.1)};
  const PreloadLine line = fit_preload_line(two);
  CHECK_THAT(line.slope, WithinRel(0.2, kExact));
  CHECK_THAT(line.intercept(), WithinRel(1.0, kExact));
  CHECK_THAT(line.intercept_sd(), WithinRel(0.3, kExact));
  CHECK_THAT(line.slope_sd(), WithinRel(std::hypot(0.3, 0.1) / 10, kExact));
  for (const double x : {0.0, 4.0, 10.0, 12.0})
    CHECK_THAT(line.sd(x), WithinRel(std::hypot(0.3 * (1 - x / 10), 0.1 * x / 10), kExact));
  CHECK_THAT(line.t_quantile, WithinAbs(1.959964, 1e-5));
  CHECK(line.misfit == 0);
  CHECK(line.p_value == 1);
  CHECK(line.low == 0);
  CHECK_THAT(line.high, WithinRel(12.0, kExact));
  CHECK(line.holds(12));
  CHECK_FALSE(line.holds(12.1));
}

TEST_CASE("two preloads without sd make a line without one", "[design]") {
  const std::vector<PreloadEstimate> two = {at(1, 1, 0), at(11, 3, 0)};
  const PreloadLine line = fit_preload_line(two);
  CHECK_THAT(line.value(6), WithinRel(2.0, kExact));
  CHECK(std::isnan(line.sd(6)));
  CHECK(line.low == 0);  // not below: 1 - 2
}

// x = -1, 0, 1 around 5 with y = 0, 3, 0: middle 1, slope 0, residuals -1, 2, -1. With equal sd s
// chi-squared is 6 / s^2 (1 degree of freedom): the misfit makes s^2 + misfit^2 = 6.
TEST_CASE("a misfit of three preloads is part of the sd", "[design]") {
  const double s = 0.5;
  const std::vector<PreloadEstimate> three = {at(4, 0, s), at(5, 3, s), at(6, 0, s)};
  const PreloadLine line = fit_preload_line(three);
  CHECK_THAT(line.misfit * line.misfit, WithinRel(6 - s * s, kExact));
  CHECK_THAT(line.sd(5), WithinRel(std::sqrt(6.0 / 3 + 6 - s * s), kExact));
  CHECK_THAT(line.sd(6), WithinRel(std::sqrt(6.0 / 3 + 6.0 / 2 + 6 - s * s), kExact));
  // P(chi^2_1 > 24) = erfc(sqrt(12))
  CHECK_THAT(line.p_value, WithinRel(std::erfc(std::sqrt(12.0)), 1e-9));
  CHECK(line.t_quantile > 10);  // nearly Student's t with one degree of freedom, 12.7
}

// y = 2 x exactly, x known to 0.1: the effective variance is 4 times that of x; with y fully
// correlated with x (cov = 2 var_x, var_y = 4 var_x) nothing is left of it.
TEST_CASE("an uncertain preload makes the line less sure", "[design]") {
  std::vector<PreloadEstimate> two = {{1, 2, 0.01, 0, 0}, {3, 6, 0.01, 0, 0}};
  CHECK_THAT(fit_preload_line(two).sd(1), WithinRel(0.2, kExact));
  for (PreloadEstimate& e : two) {
    e.var_y = 0.04;
    e.cov = 0.02;
  }
  CHECK((std::isnan(fit_preload_line(two).sd(1)) || fit_preload_line(two).sd(1) < 1e-9));
}

struct Covered {
  int n = 0, inside = 0;
  double share() const { return inside / static_cast<double>(n); }
};

/// Bands of lines through estimates with noise at `fitted`, at preloads that were not fitted.
Covered covered_by_bands(const std::vector<double>& fitted, double bend, int n_runs) {
  truth::Random random = truth::stream(7, 1);
  Covered out;
  for (int run = 0; run < n_runs; ++run) {
    std::vector<PreloadEstimate> all;
    for (const double x : fitted) {
      const double sd = 0.02 + 0.01 * x, scatter = bend * random.normal();
      all.push_back(at(x, 3 + 0.25 * x + sd * random.normal() + scatter, sd));
    }
    const PreloadLine line = fit_preload_line(all);
    for (const double x : {2.0, 7.0, 11.0}) {
      const double truth = 3 + 0.25 * x + bend * random.normal();
      ++out.n;
      out.inside += std::abs(line.value(x) - truth) <= line.t_quantile * line.sd(x);
    }
  }
  return out;
}

// 2000 runs (20,000 with CABLEFIT_MONTE_CARLO=full) of three preloads each. Two preloads: exact. A
// misfit is only ever added, so that more preloads cover more than 95 %; where the truth itself
// scatters about the line by more than the sd, the three degrees of freedom of five preloads say
// how much.
TEST_CASE("bands between preloads hold the truth", "[design][monte-carlo]") {
  const int n_runs = test::full_monte_carlo() ? 20000 : 2000;
  const struct {
    const char* name;
    std::vector<double> fitted;
    double bend, least, most;
  } cases[] = {{"two preloads", {1, 10}, 0, 0.94, 0.96},
               {"three preloads", {0, 4, 10}, 0, 0.94, 0.98},
               {"five preloads", {0, 2.5, 5, 7.5, 10}, 0, 0.94, 0.98},
               {"five preloads, scatter", {0, 2.5, 5, 7.5, 10}, 0.3, 0.90, 0.98}};
  for (const auto& one : cases) {
    const Covered found = covered_by_bands(one.fitted, one.bend, n_runs);
    std::printf("    %-24s %.1f %% of %d bands hold the truth\n", one.name, 100 * found.share(),
                found.n);
    CHECK(found.share() > one.least);
    CHECK(found.share() < one.most);
  }
}

}  // namespace
