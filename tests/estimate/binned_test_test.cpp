// Means over bins: how often it cries wolf on white and on coloured noise, fitted and unseen rows,
// and that it sees what is there.
#include "cablefit/estimate/tests/binned_test.hpp"

#include <Eigen/QR>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <vector>

#include "tests/support/columns.hpp"

namespace {

using namespace cablefit;

constexpr Eigen::Index kBinnedRows = 4000;

/// A made-up fit: y = W x + noise, W = [speed, sign, 1]; the variable is a position.
struct Case {
  Eigen::MatrixXd w = Eigen::MatrixXd(kBinnedRows, 3);
  Eigen::VectorXd position = Eigen::VectorXd(kBinnedRows), noise = Eigen::VectorXd(kBinnedRows);

  Case(double rho, std::uint64_t seed) {
    test::Normal normal(seed);
    const double a = normal.uniform(), b = normal.uniform();
    double state = normal() / std::sqrt(1 - rho * rho);
    for (Eigen::Index i = 0; i < kBinnedRows; ++i) {
      const double t = 0.005 * static_cast<double>(i);
      position(i) = std::sin(1.7 * t + a) + 0.6 * std::sin(4.3 * t + b);
      const double speed = 1.7 * std::cos(1.7 * t + a) + 2.58 * std::cos(4.3 * t + b);
      w.row(i) << speed, test::sign(speed), 1;
      state = rho * state + normal();
      noise(i) = state * std::sqrt(1 - rho * rho);
    }
  }
};

std::vector<Eigen::Index> places() {
  std::vector<Eigen::Index> numbers(kBinnedRows);
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

BinnedTest binned(const Case& c, const Eigen::VectorXd& variable, const Eigen::VectorXd& residual) {
  BinnedTest test(bin_edges({variable.data(), variable.data() + kBinnedRows}, 8), 3, 4);
  test.add(places(), variable, residual, c.w);
  return test;
}

Eigen::VectorXd fit(const Case& c, const Eigen::VectorXd& y) {
  return c.w.colPivHouseholderQr().solve(y);
}

BinnedTestResult fitted(const Case& c, const Eigen::VectorXd& variable, const Eigen::VectorXd& y) {
  return binned(c, variable, y - c.w * fit(c, y)).of_fitted_rows();
}

constexpr int kDataSets = 300;
// 15 of 300 expected at 5 %; HAC covariances of 7 means refuse somewhat more than they say, the
// more the slower the noise. 42 is 14 %.
constexpr int kMostRefused = 42;

TEST_CASE("the test of bins keeps its level on white and coloured noise", "[estimate]") {
  for (const double rho : {0.0, 0.8, 0.95}) {
    int refused = 0, refused_unseen = 0;
    for (int run = 0; run < kDataSets; ++run) {
      const Case c(rho, 4000 + static_cast<unsigned>(run));
      refused += fitted(c, c.position, c.noise).p_value < 0.05;
      const Case other(rho, 9000 + static_cast<unsigned>(run));
      // The parameters' covariance as white noise of the same long-run variance would give it.
      const double growth = (1 + rho) / (1 - rho);
      const Eigen::MatrixXd covariance =
          growth *
          (other.w.transpose() * other.w).completeOrthogonalDecomposition().pseudoInverse();
      const Eigen::VectorXd unseen = c.noise - c.w * fit(other, other.noise);
      refused_unseen += binned(c, c.position, unseen).of_unseen_rows(covariance).p_value < 0.05;
    }
    std::printf("  correlation %.2f a row: refused at 5 %%: %d of %d fitted, %d unseen\n", rho,
                refused, kDataSets, refused_unseen);
    CHECK(refused <= kMostRefused);
    CHECK(refused_unseen <= kMostRefused);
  }
}

TEST_CASE("what depends on position is seen, with its size and place", "[estimate]") {
  const Case c(0.8, 41);
  const Eigen::VectorXd y = c.noise + 0.8 * (2.5 * c.position.array()).sin().matrix();
  const BinnedTestResult seen = fitted(c, c.position, y);
  CHECK(seen.p_value < 1e-4);
  // 0.8 sin over all its phases has an rms of 0.57, less what the bins smear and the offset takes.
  CHECK(seen.structure > 0.4);
  CHECK(seen.structure < 0.6);
  CHECK(std::abs(seen.largest) > 0.5);
  CHECK(fitted(c, c.position, c.noise).structure < 0.15);
}

TEST_CASE("what the regressors explain cannot be tested on the rows they were fitted to",
          "[estimate]") {
  const Case c(0, 42);
  const Eigen::VectorXd sign = c.w.col(1);
  CHECK_FALSE(fitted(c, sign, c.noise).is_possible);
  const Eigen::VectorXd shifted = c.noise + 0.3 * sign;
  const BinnedTestResult unseen =
      binned(c, sign, shifted).of_unseen_rows(Eigen::MatrixXd::Zero(3, 3));
  CHECK(unseen.is_possible);
  CHECK(unseen.p_value < 1e-6);
}

TEST_CASE("parameters that are uncertain are allowed for on unseen rows", "[estimate]") {
  const Case c(0, 43);
  const Eigen::VectorXd off = c.noise + 0.2 * Eigen::VectorXd::Ones(kBinnedRows);
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(3, 3);
  CHECK(binned(c, c.position, off).of_unseen_rows(covariance).p_value < 1e-6);
  covariance(2, 2) = 0.2 * 0.2;
  CHECK(binned(c, c.position, off).of_unseen_rows(covariance).p_value > 0.01);
}

TEST_CASE("levels get a bin each, a variable that stands still none", "[estimate]") {
  CHECK(bin_edges({-40, 30, 30, -40, -40}, 4) == std::vector<double>{-5});
  CHECK(bin_edges({7, 7, 7, NAN}, 4).empty());
  CHECK(bin_edges({1, 2, 3, 4, 5, 6, 7, 8}, 4) == std::vector<double>{3, 5, 7});
  CHECK(bin_of(5, {3, 5, 7}) == 2);
}

}  // namespace
