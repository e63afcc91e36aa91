// The time error of samples is separated from independent noise of the encoders.
#include "cablefit/copies/clock_jitter.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "cablefit/base/random.hpp"

namespace {

using namespace cablefit;

constexpr Eigen::Index kRows = 20000;
constexpr double kPeriod = 1e-3, kAmplitude = 0.5, kOmega = 6;

struct Motion {
  PositionPair exact{Eigen::ArrayXd(kRows), Eigen::ArrayXd(kRows)}, read = exact;
  Eigen::ArrayXd speeds = Eigen::ArrayXd(kRows);
};

/// A sine read `jitter` late or early, with noise of `noise` on each encoder.
Motion sine(double jitter, double noise) {
  Motion m;
  Random random(7);
  for (Eigen::Index i = 0; i < kRows; ++i) {
    const double t = kPeriod * static_cast<double>(i), speed = kAmplitude * kOmega;
    const double late = t + jitter * random.normal();
    m.exact.q(i) = kAmplitude * std::sin(kOmega * t);
    m.exact.theta(i) = 1.02 * m.exact.q(i);
    m.read.q(i) = kAmplitude * std::sin(kOmega * late) + noise * random.normal();
    m.read.theta(i) = 1.02 * kAmplitude * std::sin(kOmega * late) + noise * random.normal();
    m.speeds(i) = 1.02 * std::pow(speed * std::cos(kOmega * t), 2);
  }
  return m;
}

double found(const Motion& m) { return clock_jitter(m.read, m.exact, m.speeds); }

// sd of the estimate: half of sqrt(2.9 / 20000) with little noise, about 1 %.
TEST_CASE("a jitter of 20 us is found", "[copies]") {
  CHECK(found(sine(20e-6, 1e-6)) == Approx(20e-6).epsilon(0.04));
  CHECK(found(sine(20e-6, 20e-6)) == Approx(20e-6).epsilon(0.1));
}

TEST_CASE("independent noise of two encoders is no jitter", "[copies]") {
  CHECK(found(sine(0, 30e-6)) == 0);
  CHECK(found(sine(0, 0)) == 0);
}

// Sixth differences of a fast motion are its own: those of the simulated motion are taken off.
TEST_CASE("the motion itself is no jitter", "[copies]") {
  Motion m = sine(0, 1e-7);
  const Eigen::ArrayXd fast =
      1e-4 * (2 * 3.1 * 100 * Eigen::ArrayXd::LinSpaced(kRows, 0, kPeriod * (kRows - 1))).sin();
  for (Eigen::ArrayXd* position : {&m.exact.q, &m.exact.theta, &m.read.q, &m.read.theta})
    *position += fast;
  CHECK(found(m) == 0);
}

}  // namespace
