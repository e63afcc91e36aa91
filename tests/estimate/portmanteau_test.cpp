// Whiteness: Ljung and Box's Q against R, the filter's own colour let through, memory seen.
#include "cablefit/estimate/tests/portmanteau.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <vector>

#include "tests/support/columns.hpp"

namespace {

using namespace cablefit;

std::vector<Eigen::Index> places(std::size_t n) {
  std::vector<Eigen::Index> numbers(n);
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

WhitenessTest whiteness(const Eigen::VectorXd& x) {
  Portmanteau test;
  test.add(places(static_cast<std::size_t>(x.size())), x);
  return test.result();
}

// R 4.2.2: x <- sin(0.7*(0:799)^2) + 0.5*sin(0.7*(1:800)^2); b <- colMeans(matrix(x, 4));
// Q = n (n+2) sum_k (sum b_i b_(i+k) / sum b^2)^2 / (n-k), k = 1..20; pchisq(Q, 20, lower = FALSE).
TEST_CASE("Ljung and Box's statistic is that of R", "[estimate]") {
  Eigen::VectorXd x(800);
  for (Eigen::Index i = 0; i < 800; ++i) {
    const auto t = static_cast<double>(i);
    x(i) = std::sin(0.7 * t * t) + 0.5 * std::sin(0.7 * (t + 1) * (t + 1));
  }
  const WhitenessTest test = whiteness(x);
  CHECK(test.lags == 20);
  // sin(0.7 i^2) loses i^2 eps = 1e-10 of its argument.
  CHECK_THAT(test.statistic, Catch::WithinRel(10.034228045911803, 1e-9));
  CHECK_THAT(test.p_value, Catch::WithinRel(0.96754703558646726, 1e-9));
}

/// White noise through the low-pass of a log: nothing beyond 0.8 of the rows' Nyquist frequency.
Eigen::VectorXd filtered_noise(Eigen::Index n, std::uint64_t seed) {
  test::Normal normal(seed);
  constexpr Eigen::Index kReach = 40;
  Eigen::VectorXd white(n + 2 * kReach), out = Eigen::VectorXd::Zero(n);
  for (double& w : white) w = normal();
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index k = -kReach; k <= kReach; ++k) {
      const double x = 0.8 * M_PI * static_cast<double>(k);
      const double window = 0.54 + 0.46 * std::cos(M_PI * static_cast<double>(k) / kReach);
      out(i) += white(i + kReach + k) * 0.8 * window * (k == 0 ? 1 : std::sin(x) / x);
    }
  return out;
}

TEST_CASE("what the filter does to white noise is not held against it", "[estimate]") {
  int refused = 0;
  constexpr int kRuns = 200;
  double effective = 0;
  for (int run = 0; run < kRuns; ++run) {
    const WhitenessTest test = whiteness(filtered_noise(4000, 900 + static_cast<unsigned>(run)));
    refused += test.p_value < 0.05;
    effective += test.effective_rows / 4000 / kRuns;
  }
  std::printf("  white through the filter: refused at 5 %%: %d of %d, effective share %.2f\n",
              refused, kRuns, effective);
  // 10 expected; 21 is the upper 99.9 % of the binomial. The rows themselves would be refused
  // always.
  CHECK(refused <= 21);
  CHECK(effective > 0.7);
}

TEST_CASE("a residual with a memory is told, and what its rows are worth", "[estimate]") {
  constexpr double kRho = 0.95;
  test::Normal normal(77);
  Eigen::VectorXd x(20000);
  double state = 0;
  for (double& v : x) v = state = kRho * state + normal();
  const WhitenessTest test = whiteness(x);
  CHECK(test.p_value < 1e-6);
  // n (1 - rho)/(1 + rho) = 513 independent values; the sum over correlations stops where they are
  // lost in noise, 5 to 20 % too early.
  CHECK(test.effective_rows > 400);
  CHECK(test.effective_rows < 750);
}

TEST_CASE("holes do not make neighbours", "[estimate]") {
  // Alternating stretches of 4 rows kept and 4 left out, a residual that changes sign with each:
  // as neighbours the block means would have correlation -1, by their places they have +-1 at even
  // lags only.
  Portmanteau test;
  test::Normal normal(5);
  for (Eigen::Index k = 0; k < 400; ++k) {
    const std::vector<Eigen::Index> numbers = {8 * k, 8 * k + 1, 8 * k + 2, 8 * k + 3};
    test.add(numbers, Eigen::VectorXd::Constant(4, normal()));
  }
  CHECK(test.result().p_value > 0.01);
  CHECK(test.result().lags == 20);
}

}  // namespace
