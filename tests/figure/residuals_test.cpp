// Distribution and memory of residuals.
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <random>

#include "cablefit/figure/autocorrelation.hpp"
#include "cablefit/figure/histogram.hpp"

namespace {

using namespace cablefit;

TEST_CASE("a histogram is a density, next to that of the normal distribution") {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  Histogram histogram;
  for (int i = 0; i < 400000; ++i) histogram.add(normal(random));
  histogram.add(std::nan(""));
  Trace bins, curve;
  histogram.draw(bins);
  Histogram::draw_normal(curve);
  const double width = bins.x[1] - bins.x[0];
  const double area = width * std::accumulate(bins.y.begin(), bins.y.end(), 0.0);
  CHECK_THAT(area, Catch::WithinAbs(1 - histogram.share_beyond(), 1e-12));
  // Density 0.4 at 0: 4 sd of a count of 20000 are 3 %, the curve falls by 0.1 % within the bin.
  CHECK_THAT(bins.y[bins.y.size() / 2], Catch::WithinRel(curve.y[curve.y.size() / 2], 0.035));
}

TEST_CASE("values beyond the histogram are counted") {
  Histogram histogram;
  for (const double value : {0.0, 4.9, 5.1, -1e9}) histogram.add(value);
  CHECK(histogram.share_beyond() == 0.5);
}

/// x_k = a x_(k-1) + white, whose autocorrelation is a^lag.
Eigen::VectorXd first_order(Eigen::Index n, double a) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  Eigen::VectorXd x(n);
  double last = 0;
  for (Eigen::Index i = 0; i < n; ++i) x(i) = last = a * last + normal(random);
  return x;
}

std::vector<Eigen::Index> numbers_from(Eigen::Index first, Eigen::Index n) {
  std::vector<Eigen::Index> numbers(static_cast<std::size_t>(n));
  std::iota(numbers.begin(), numbers.end(), first);
  return numbers;
}

TEST_CASE("autocorrelation of a first-order process") {
  const Eigen::Index n = 200000;
  const Eigen::VectorXd x = first_order(n, 0.8);
  Autocorrelation memory;
  memory.add(numbers_from(0, n), x);
  Trace trace;
  memory.draw(trace);
  REQUIRE(trace.x.size() == static_cast<std::size_t>(kMostLags));
  // sd of an estimated rho: below sqrt((1 + a^2)/(1 - a^2)/n) = 0.005 (Bartlett); 4 of them.
  for (std::size_t k = 0; k < trace.x.size(); ++k)
    CHECK_THAT(trace.y[k], Catch::WithinAbs(std::pow(0.8, trace.x[k]), 0.02));
  CHECK_THAT(memory.white_band(), Catch::WithinRel(1.96 / std::sqrt(200000.0), 1e-12));
}

TEST_CASE("autocorrelation does not depend on how rows are dealt to windows") {
  const Eigen::Index n = 5000;
  const Eigen::VectorXd x = first_order(n, 0.5);
  Autocorrelation whole, dealt;
  whole.add(numbers_from(0, n), x);
  for (Eigen::Index first = 0; first < n; first += 7)
    dealt.add(numbers_from(first, std::min<Eigen::Index>(7, n - first)),
              x.segment(first, std::min<Eigen::Index>(7, n - first)));
  Trace a, b;
  whole.draw(a);
  dealt.draw(b);
  REQUIRE(a.y.size() == b.y.size());
  for (std::size_t k = 0; k < a.y.size(); ++k) CHECK_THAT(b.y[k], Catch::WithinAbs(a.y[k], 1e-12));
}

TEST_CASE("rows on both sides of a hole are as far apart as their numbers say") {
  // Every tenth row only: pairs exist at lags 10, 20, ... alone.
  Autocorrelation memory;
  std::vector<Eigen::Index> numbers;
  for (Eigen::Index i = 0; i < 100; ++i) numbers.push_back(10 * i);
  memory.add(numbers, Eigen::VectorXd::Ones(100));
  memory.add({100000}, Eigen::VectorXd::Ones(1));  // far away: pairs with nothing
  Trace trace;
  memory.draw(trace);
  CHECK(trace.x == std::vector<double>{10, 20, 30, 40, 50, 60});
}

}  // namespace
