// Derivatives, averages, held torque and directions of a window made by hand.
#include "cablefit/samples/rows/signals.hpp"
#include "cablefit/samples/rows/decimation.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace {

using namespace cablefit;

constexpr double kPeriod = 0.01;
constexpr Eigen::Index kRows = 60;

/// One joint with the channels given, in this order; a whole segment.
struct Fixture {
  LogPlan plan;
  Window window;

  explicit Fixture(const std::vector<Channel>& channels) {
    plan.rig = default_rig();
    for (std::size_t k = 0; k < channels.size(); ++k)
      plan.slots.push_back({channels[k], 0, k, 1, 0});
    window.end = kRows;
    window.period = kPeriod;
    window.starts_segment = window.ends_segment = true;
    window.data = Eigen::MatrixXd::Zero(kRows, static_cast<Eigen::Index>(channels.size()));
    window.approach = Eigen::MatrixXd::Zero(kRows, 1);
  }
  JointSignals signals(const SignalSettings& settings = {}) const {
    return make_signals(window, plan, settings).joints.at(0);
  }
};

double time_at(Eigen::Index i) { return kPeriod * static_cast<double>(i); }

// A five-point stencil of fourth order is exact for quartics: both derivatives, up to rounding:
// values of 20 with a rounding of 2e-15, over 12 h^2 = 1.2e-3 with weights of 64: 2e-10.
TEST_CASE("differences are exact for quartic polynomials", "[samples]") {
  Fixture f({Channel::q, Channel::theta});
  const auto quartic = [](double t) {
    return 3 - 2 * t + 5 * t * t - 7 * t * t * t + 4 * t * t * t * t;
  };
  const auto first = [](double t) { return -2 + 10 * t - 21 * t * t + 16 * t * t * t; };
  const auto second = [](double t) { return 10 - 42 * t + 48 * t * t; };
  for (Eigen::Index i = 0; i < kRows; ++i) {
    f.window.data(i, 0) = quartic(time_at(i));
    f.window.data(i, 1) = -2 * quartic(time_at(i));
  }
  const JointSignals s = f.signals();
  for (Eigen::Index i = kDifferenceEdge; i < kRows - kDifferenceEdge; ++i) {
    CHECK_THAT(s.qd(i), Catch::WithinAbs(first(time_at(i)), 1e-11));
    CHECK_THAT(s.qdd(i), Catch::WithinAbs(second(time_at(i)), 1e-9));
    CHECK_THAT(s.thetad(i), Catch::WithinAbs(-2 * first(time_at(i)), 1e-11));
    CHECK_THAT(s.thetadd(i), Catch::WithinAbs(-2 * second(time_at(i)), 1e-9));
  }
}

TEST_CASE("a velocity is differentiated once", "[samples]") {
  Fixture f({Channel::w, Channel::tau, Channel::theta});
  f.plan.slots[2].integrated = true;
  for (Eigen::Index i = 0; i < kRows; ++i)
    f.window.data(i, 0) = std::pow(time_at(i), 4) - time_at(i);
  const JointSignals s = f.signals();
  CHECK(s.q.size() == 0);
  for (Eigen::Index i = kDifferenceEdge; i < kRows - kDifferenceEdge; ++i) {
    CHECK(s.thetad(i) == f.window.data(i, 0));
    CHECK_THAT(s.thetadd(i), Catch::WithinAbs(4 * std::pow(time_at(i), 3) - 1, 1e-11));
  }
}

TEST_CASE("a held torque is moved by half the hold", "[samples]") {
  Fixture f({Channel::theta, Channel::tau});
  for (Eigen::Index i = 0; i < kRows; ++i) f.window.data(i, 1) = std::pow(time_at(i), 2) + 1;
  const auto tau = f.window.data.col(1);
  SignalSettings held;
  held.torque_held = true;
  const JointSignals one = f.signals(held);
  held.torque_period = 3 * kPeriod;  // half of it: one and a half rows
  const JointSignals three = f.signals(held);
  const JointSignals none = f.signals();
  for (Eigen::Index i = 2; i < kRows; ++i) {
    CHECK(none.tau(i) == tau(i));
    CHECK_THAT(one.tau(i), Catch::WithinAbs(0.5 * (tau(i) + tau(i - 1)), 1e-15));
    CHECK_THAT(three.tau(i), Catch::WithinAbs(0.5 * (tau(i - 1) + tau(i - 2)), 1e-13));
  }
}

// What the average is for (Numerov): the second difference of theta is the triangle average of the
// true acceleration, so that cablefit's averaged five-point acceleration must equal it to h^4.
TEST_CASE("an averaged acceleration is the three-point second difference", "[samples]") {
  Fixture f({Channel::theta});
  const double omega = 40;  // omega h = 0.4
  for (Eigen::Index i = 0; i < kRows; ++i) f.window.data(i, 0) = std::sin(omega * time_at(i));
  const JointSignals s = f.signals();
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < kRows; ++i) rows.push_back(i);
  const Eigen::ArrayXd averaged =
      Decimation(1).apply(s.thetadd.matrix(), rows, 0, kRows, {true}).col(0).array();
  const auto x = f.window.data.col(0);
  double worst = 0, raw = 0;
  for (Eigen::Index i = 4; i < kRows - 4; ++i) {
    const double second = (x(i - 1) - 2 * x(i) + x(i + 1)) / (kPeriod * kPeriod);
    worst = std::max(worst, std::abs(averaged(i) - second));
    raw = std::max(raw, std::abs(s.thetadd(i) - second));
  }
  // Leading terms: (omega h)^4/90 of the stencil and /480 of the triangle, 3.4e-4 of omega^2;
  // without the average (omega h)^2/12 = 1.3 %.
  CHECK(worst < 5e-4 * omega * omega);
  CHECK(raw > 0.01 * omega * omega);
}

TEST_CASE("a load law acts at the position there is", "[samples]") {
  Fixture f({Channel::theta, Channel::tau});
  f.plan.rig.load.law = &find_load_law("pendulum");
  f.plan.rig.load.parameters.mass = 2;
  f.plan.rig.load.parameters.length = 0.5;
  for (Eigen::Index i = 0; i < kRows; ++i) f.window.data(i, 0) = 0.01 * static_cast<double>(i);
  const JointSignals s = f.signals();
  for (Eigen::Index i = 0; i < kRows; ++i)
    CHECK_THAT(s.tau_load(i), Catch::WithinAbs(-kGravity * std::sin(f.window.data(i, 0)), 1e-13));
}

}  // namespace
