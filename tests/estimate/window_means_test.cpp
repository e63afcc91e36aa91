// How far means over windows are from zero, for noise whose answer is known.
#include "cablefit/estimate/spread/window_means.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "cablefit/base/random.hpp"

namespace {

using namespace cablefit;

constexpr Eigen::Index kRows = 200000;

std::vector<WindowMean> means_of(const Eigen::VectorXd& x, Eigen::Index hole = -1) {
  WindowMeans means;
  std::vector<Eigen::Index> numbers;
  std::vector<double> values;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (i == hole) continue;
    numbers.push_back(i);
    values.push_back(x(i));
  }
  const auto half = numbers.size() / 2;
  const Eigen::Map<const Eigen::VectorXd> all(values.data(),
                                              static_cast<Eigen::Index>(values.size()));
  const std::span<const Eigen::Index> places(numbers);
  means.add(places.first(half), all.head(static_cast<Eigen::Index>(half)));
  means.add(places.subspan(half), all.tail(all.size() - static_cast<Eigen::Index>(half)));
  return means.result(0.01);
}

TEST_CASE("means of white noise shrink with the root of the window", "[estimate]") {
  Random random(3);
  Eigen::VectorXd x(kRows);
  for (double& value : x) value = random.normal();
  const std::vector<WindowMean> means = means_of(x);
  REQUIRE(means.size() >= 11);
  for (std::size_t k = 0; k < 11; ++k) {
    const double n = std::pow(2.0, static_cast<double>(k));
    CHECK(means[k].seconds == Approx(0.01 * n));
    // 4 sd of a variance of kRows / n windows.
    CHECK(means[k].sd * std::sqrt(n) == Approx(1).epsilon(2 * std::sqrt(2 * n / kRows)));
  }
}

// An AR(1) series x_i = a x_(i-1) + e: the mean of n has the variance
// s^2 / n (1 + 2 sum (1 - k/n) a^k), Box & Jenkins 1976, ch. 2.
TEST_CASE("means of slow noise hardly shrink", "[estimate]") {
  const double a = 0.95;
  Random random(4);
  Eigen::VectorXd x(kRows);
  double state = 0;
  for (double& value : x) value = state = a * state + std::sqrt(1 - a * a) * random.normal();
  const std::vector<WindowMean> means = means_of(x);
  for (const std::size_t k : {0, 2, 4, 6}) {
    const double n = std::pow(2.0, static_cast<double>(k));
    double sum = 1;
    for (int lag = 1; lag < static_cast<int>(n); ++lag) sum += 2 * (1 - lag / n) * std::pow(a, lag);
    CHECK(means[k].sd == Approx(std::sqrt(sum / n)).epsilon(0.05));
  }
}

TEST_CASE("a window with a hole does not count", "[estimate]") {
  Eigen::VectorXd x = Eigen::VectorXd::Constant(32, 2);
  x(5) = 100;
  const std::vector<WindowMean> means = means_of(x, 5);
  REQUIRE(means.size() == 1);  // 15 windows of two rows are one too few
  CHECK(means[0].sd == 2);
}

TEST_CASE("between lengths and beyond them", "[estimate]") {
  const std::vector<WindowMean> all = {{0.01, 0.4}, {0.04, 0.1}, {0.16, 0.1}};
  CHECK(sd_of_mean(all, 0.001) == 0.4);
  CHECK(sd_of_mean(all, 0.02) == Approx(0.2));
  CHECK(sd_of_mean(all, 0.08) == Approx(0.1));
  CHECK(sd_of_mean(all, 0.64) == Approx(0.05));
}

}  // namespace
