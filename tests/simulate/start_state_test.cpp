#include "cablefit/simulate/start_state.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace {

using namespace cablefit;

constexpr double kSamplePeriod = 1e-3;
constexpr double kQuantum = 2.4e-5;
constexpr Eigen::Index kRows = 200;

template <typename Motion>
Eigen::ArrayXd sampled(Motion motion, double quantum) {
  Eigen::ArrayXd x(kRows);
  for (Eigen::Index i = 0; i < kRows; ++i) {
    x(i) = motion(kSamplePeriod * static_cast<double>(i));
    if (quantum > 0) x(i) = quantum * std::round(x(i) / quantum);
  }
  return x;
}

TEST_CASE("a cubic is met exactly, in the middle and at both ends", "[simulate]") {
  const auto x = sampled([](double t) { return 0.3 + 2 * t - 5 * t * t + 40 * t * t * t; }, 0);
  for (const Eigen::Index row : {0, 1, 60, 198, 199}) {
    const double t = kSamplePeriod * static_cast<double>(row);
    const StartState state = start_state(x, row, kSamplePeriod, 1e-12);
    CHECK(state.position == Approx(x(row)).epsilon(1e-12));
    CHECK(state.velocity == Approx(2 - 10 * t + 120 * t * t).epsilon(1e-9));
  }
}

TEST_CASE("slow motion over a coarse encoder is smoothed", "[simulate]") {
  const auto x = sampled([](double t) { return 0.01 * t; }, kQuantum);
  // 65 rows: the slope of a cubic has sd 7e-6 / 1 ms * sqrt(75 / (4 * 65^3)) = 5.7e-5 rad/s for
  // white rounding; here it is regular, and no worse than three of that.
  CHECK(start_state(x, 100, kSamplePeriod, kQuantum / std::sqrt(12.0)).velocity ==
        Approx(0.01).margin(3 * 5.7e-5));
}

TEST_CASE("fast motion is followed", "[simulate]") {
  // 45 Hz at 2 rad/s, the fastest line of the shipped logs. Seven rows: the slope of a cubic has an
  // sd of 0.51 * 7e-6 / 1 ms = 3.6e-3 rad/s from rounding, and x^(5) h^4 / 40 * 12 = 4e-3 from the
  // curvature of its slope. The position is off by half a quantum from each of the two, at most.
  const double omega = 2 * M_PI * 45;
  const auto x = sampled([&](double t) { return 2 / omega * std::sin(omega * t); }, kQuantum);
  for (Eigen::Index row = 50; row < 150; ++row) {
    const double velocity = 2 * std::cos(omega * kSamplePeriod * static_cast<double>(row));
    const StartState state = start_state(x, row, kSamplePeriod, kQuantum / std::sqrt(12.0));
    CHECK(std::abs(state.velocity - velocity) < 0.03);
    const double position = 2 / omega * std::sin(omega * kSamplePeriod * static_cast<double>(row));
    CHECK(std::abs(state.position - position) < 1.5 * kQuantum);
  }
}

TEST_CASE("rest is rest, and a handful of rows will do", "[simulate]") {
  const StartState state = start_state(Eigen::ArrayXd::Constant(kRows, 0.25), 10, kSamplePeriod, 0);
  CHECK(state.position == 0.25);
  CHECK(state.velocity == 0);
  const StartState line = start_state(Eigen::Array2d(1.0, 1.5), 1, kSamplePeriod, 0);
  CHECK(line.position == Approx(1.5));
  CHECK(line.velocity == Approx(500));
}

}  // namespace
