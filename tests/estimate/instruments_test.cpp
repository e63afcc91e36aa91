// Instrumental variables, and the test for whether they are needed. Numbers in the first cases are
// R 4.2.2's: lm() in two stages, anova() of the augmented regression, pf().
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>

#include "cablefit/estimate/fit/least_squares.hpp"
#include "cablefit/estimate/spread/long_run.hpp"
#include "cablefit/estimate/spread/tail_probability.hpp"
#include "cablefit/estimate/tests/exogeneity.hpp"
#include "tests/support/columns.hpp"
#include "tests/support/monte_carlo.hpp"

namespace {

using namespace cablefit;
using cablefit::test::Normal;

RowStatistics statistics_of(const Eigen::MatrixXd& rows, bool with_cells) {
  std::vector<Eigen::Index> numbers;
  for (Eigen::Index i = 0; i < rows.rows(); ++i) numbers.push_back(i);
  RowStatistics statistics(rows.cols(), rows.rows(), with_cells);
  statistics.add(rows, numbers);
  return statistics;
}

/// Columns: 1, w, y, sin, cos; the first is its own instrument.
RowStatistics eight_rows() {
  const double error[] = {.3, -.2, .5, .1, -.4, .2, -.1, .05};
  const double y[] = {3.1, 9.5, 7.2, -5.5, -9.9, 0.4, 11.8, 6.6};
  Eigen::MatrixXd rows(8, 5);
  for (int i = 0; i < 8; ++i) {
    const double z = 10 * std::sin(1.3 * i);
    rows.row(i) << 1, 0.8 * z + error[i], y[i], z, std::cos(0.7 * i);
  }
  return statistics_of(rows, false);
}

LinearProblem line(std::vector<Eigen::Index> instruments) {
  LinearProblem problem;
  problem.regressors = {0, 1};
  problem.names = {"constant", "slope"};
  problem.response = Eigen::VectorXd::Unit(5, 2);
  problem.instruments = std::move(instruments);
  return problem;
}

void check_line(const LinearSolution& s, const double (&expected)[4]) {
  for (Eigen::Index k = 0; k < 2; ++k) {
    CHECK_THAT(s.x(k), Catch::WithinRel(expected[k], 1e-9));
    CHECK_THAT(std::sqrt(s.covariance_white(k, k)), Catch::WithinRel(expected[k + 2], 1e-9));
  }
}

TEST_CASE("two-stage least squares is R's", "[estimate]") {
  const RowStatistics rows = eight_rows();
  const LinearSolution more = solve(rows, line({0, 3, 4}));
  check_line(more, {0.937781856875, 1.3108979315, 0.688168206954, 0.126979649088});
  CHECK_THAT(more.first_stage(1), Catch::WithinRel(0.997616635679, 1e-9));
  check_line(solve(rows, line({0, 3})),
             {0.941443351245, 1.30845179909, 0.688218300523, 0.127000539654});
}

TEST_CASE("the augmented regression of Durbin, Wu and Hausman is R's", "[estimate]") {
  const ExogeneityTest test = test_exogeneity(eight_rows(), line({0, 3}));
  REQUIRE(test.possible);
  CHECK_THAT(test.statistic, Catch::WithinRel(0.306152997181, 1e-8));
  CHECK_THAT(test.p_value, Catch::WithinRel(0.603879361488, 1e-8));
  CHECK(test.p_text() == "p = 0.6");
}

TEST_CASE("the tail of F is R's", "[estimate]") {
  const double table[][4] = {{1, 1, 10, 0.340893132302},      {3.5, 3, 20, 0.0344931038851},
                             {0.4, 2, 7.5, 0.683812273158},   {12, 5, 100, 4.14040931647e-09},
                             {2.1, 4, 3000, 0.0782591050319}, {30, 3, 250, 1.33640642621e-16},
                             {0.001, 2, 5, 0.99900069958}};
  for (const auto& [f, numerator, denominator, p] : table) {
    INFO("F(" << numerator << ", " << denominator << ") = " << f);
    CHECK_THAT(f_tail(f, numerator, denominator), Catch::WithinRel(p, 1e-9));
  }
  CHECK(f_tail(0, 2, 5) == 1);
}

TEST_CASE("regressors as their own instruments are least squares", "[estimate]") {
  const RowStatistics rows = eight_rows();
  const LinearSolution plain = solve(rows, line({})), own = solve(rows, line({0, 1}));
  for (Eigen::Index k = 0; k < 2; ++k) CHECK_THAT(own.x(k), Catch::WithinRel(plain.x(k), 1e-12));
  CHECK_FALSE(test_exogeneity(rows, line({0, 1})).possible);
}

TEST_CASE("an instrument that never moves determines nothing", "[estimate]") {
  const LinearSolution s = solve(eight_rows(), line({0}));
  CHECK_FALSE(s.not_identifiable[1].empty());
}

constexpr Eigen::Index kDrawnRows = 2000;
constexpr double kTruth = 2;

/// Rows [1, w, y, z]: y = 0.5 + 2 w + e with e an AR(1) (0.8) of unit variance; w = w0 + share of e
/// + 0.1 of noise, w0 a sum of sines of unit variance; z = w0, or noise when it is `strange`.
RowStatistics loop(double share, bool strange, std::uint64_t seed) {
  Normal normal(seed);
  Eigen::MatrixXd rows(kDrawnRows, 4);
  double e = normal();
  for (Eigen::Index i = 0; i < kDrawnRows; ++i) {
    const double t = 2 * std::numbers::pi * static_cast<double>(i) / kDrawnRows;
    const double w0 = std::sin(7 * t) + std::sin(31 * t + 1);
    const double w = w0 + share * e + 0.1 * normal();
    rows.row(i) << 1, w, 0.5 + kTruth * w + e, strange ? normal() : w0;
    e = 0.8 * e + 0.6 * normal();
  }
  return statistics_of(rows, true);
}

LinearProblem loop_problem(std::vector<Eigen::Index> instruments) {
  LinearProblem problem = line(std::move(instruments));
  problem.response = Eigen::VectorXd::Unit(4, 2);
  return problem;
}

struct Tally {
  double iv_bias = 0, ls_bias = 0, covered = 0, rejected = 0;
};

Tally tally(double share, int n_runs, std::uint64_t seed) {
  Tally all;
  for (int run = 0; run < n_runs; ++run) {
    const RowStatistics rows = loop(share, false, seed + static_cast<std::uint64_t>(run));
    const LinearSolution iv = solve(rows, loop_problem({0, 3}));
    const double half = t_quantile_975(iv.degrees_of_freedom) * std::sqrt(iv.covariance(1, 1));
    all.iv_bias += (iv.x(1) - kTruth) / n_runs;
    all.ls_bias += (solve(rows, loop_problem({})).x(1) - kTruth) / n_runs;
    all.covered += (std::abs(iv.x(1) - kTruth) < half) / static_cast<double>(n_runs);
    all.rejected +=
        (test_exogeneity(rows, loop_problem({0, 3})).p_value < 0.05) / static_cast<double>(n_runs);
  }
  return all;
}

int n_runs() { return test::full_monte_carlo() ? 4000 : 400; }

// The residual feeds back into the regressor as a disturbance does through a controller: w has
// variance 1 + 0.3^2 + 0.1^2 and covariance 0.3 with e, so that least squares is off by 0.3/1.1.
TEST_CASE("instruments undo feedback, with honest intervals", "[estimate][monte-carlo]") {
  const Tally t = tally(0.3, n_runs(), 91000);
  std::printf("  feedback: bias least squares %+.3f, iv %+.4f, covered %.1f %%, rejected %.1f %%\n",
              t.ls_bias, t.iv_bias, 100 * t.covered, 100 * t.rejected);
  CHECK_THAT(t.ls_bias, Catch::WithinAbs(0.273, 0.02));
  // sd of one run: the residual at the sines' frequencies (7 and 31 per log) has a long-run sd of
  // 0.6/|1 - 0.8 exp(i w)| = 3 at most: 3/sqrt(2000) = 0.067; of the mean of 400 runs 0.0034.
  CHECK(std::abs(t.iv_bias) < 3 * 0.0034);
  const double band = 3.29 * std::sqrt(0.95 * 0.05 / n_runs());
  CHECK(t.covered > 0.95 - band - 0.02);  // as for least squares, coverage_test.cpp
  CHECK(t.covered < 0.95 + band + 0.01);
  CHECK(t.rejected > 0.95);
}

TEST_CASE("exogenous regressors are rejected in one of twenty logs", "[estimate][monte-carlo]") {
  const Tally t = tally(0, n_runs(), 95000);
  std::printf("  no feedback: rejected %.1f %%, covered %.1f %%\n", 100 * t.rejected,
              100 * t.covered);
  const double band = 3.29 * std::sqrt(0.95 * 0.05 / n_runs());
  CHECK(t.rejected < 0.05 + band + 0.01);
  CHECK(t.rejected > 0.05 - band - 0.01);
}

TEST_CASE("weak instruments are named", "[estimate]") {
  const LinearSolution weak = solve(loop(0.3, true, 7), loop_problem({0, 3}));
  const LinearSolution strong = solve(loop(0.3, false, 7), loop_problem({0, 3}));
  REQUIRE_FALSE(weak.warnings.empty());
  CHECK(weak.warnings.back().find(
            "weak instruments: the simulated motion does not determine slope well "
            "(first-stage F = ") == 0);
  CHECK(weak.first_stage(1) < 0.02);
  CHECK(strong.warnings.empty());
  CHECK(strong.first_stage(1) > 0.8);
}

LinearSolution solution_at(double x, double sd) {
  LinearSolution s;
  s.x = Eigen::Vector2d(x, 5);
  s.covariance = Eigen::Matrix2d::Zero();
  s.covariance(0, 0) = sd * sd;
  return s;
}

// For any p: below half an sd the least-squares estimate is kept. Above it but below half a per
// cent, the difference is reported as small.
TEST_CASE("what instruments change is judged by its size too", "[estimate]") {
  const auto judged = [](double plain, double with, double sd) {
    return judge_difference(largest_difference(solution_at(plain, sd), solution_at(with, sd)));
  };
  CHECK(judged(1.0, 1.0049, 0.01) == Difference::none);    // 0.49 sd
  CHECK(judged(0.01, 0.0149, 0.01) == Difference::none);   // a third of itself, but badly known
  CHECK(judged(1.0, 1.0049, 0.001) == Difference::small);  // 4.9 sd, 0.49 %
  CHECK(judged(1.0, 1.0061, 0.001) == Difference::material);
  CHECK(judged(1.0, 0.994, 0.01) == Difference::material);  // -0.6 sd, -0.6 %
  const EstimateDifference d = largest_difference(solution_at(1, 0.01), solution_at(0.98, 0.01));
  CHECK(d.parameter == 0);
  CHECK(d.in_sd == Approx(-2));
  CHECK(d.relative == Approx(-0.02 / 0.98));
  CHECK(largest_difference(solution_at(1, 0), solution_at(2, 0)).parameter == -1);
  CHECK(judge_difference({}) == Difference::none);
}

}  // namespace
