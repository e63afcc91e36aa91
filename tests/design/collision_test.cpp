// Contacts at the stated torque are detected at the stated rates.
#include "cablefit/design/collision.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>

#include "cablefit/base/random.hpp"
#include "cablefit/design/curves/curve_models.hpp"
#include "cablefit/design/curves/equilibrium_preload.hpp"
#include "cablefit/estimate/spread/window_means.hpp"
#include "tests/simulate/benches.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

constexpr int kContacts = 4000;

/// Four binomial sd: one false alarm of this test in 16000.
double bound(double rate) { return 4 * std::sqrt(rate * (1 - rate) / kContacts); }

CollisionDetector detector(double model_error) {
  CollisionDetector d;
  d.noise = 0.3;
  d.rate = 1000;
  d.window = 0.05;
  d.model_error = model_error;
  d.false_alarm_rate = 0.02;  // so often that 4000 windows can tell
  d.detection_rate = 0.95;
  return d;
}

// z(0.99) = 2.3263478740, z(0.98) = 2.0537489106, z(0.95) = 1.6448536270 (Abramowitz & Stegun,
// table 26.5). Without a model error both tails alarm: h = z(0.99) s. With one that is many sd
// large only the near one: h = E + z(0.98) s, and the contact has to overcome it from the far side.
TEST_CASE("thresholds are normal quantiles", "[design]") {
  const double s = 0.3 / std::sqrt(50.0);
  const CollisionThreshold exact = collision_threshold(detector(0));
  CHECK(exact.n_rows == 50);
  CHECK_THAT(exact.mean_noise, WithinRel(s, 1e-14));
  CHECK_THAT(exact.threshold, WithinRel(2.3263478740 * s, 1e-9));
  // The far tail of a contact, P(g < -2.33 - 3.97), is 1e-10 of 0.95.
  CHECK_THAT(exact.torque, WithinRel((2.3263478740 + 1.6448536270) * s, 1e-8));
  CHECK_THAT(exact.delay, WithinAbs(0.1, 1e-15));
  const CollisionThreshold wrong = collision_threshold(detector(3));
  CHECK_THAT(wrong.threshold, WithinRel(3 + 2.0537489106 * s, 1e-9));
  CHECK_THAT(wrong.torque, WithinRel(6 + (2.0537489106 + 1.6448536270) * s, 1e-9));
  CollisionDetector silent = detector(3);
  silent.noise = 0;
  CHECK(collision_threshold(silent).torque == 6);
  CHECK_THAT(false_alarm_rate_of(2, 0.05), WithinRel(2 * 0.05 / 3600, 1e-14));
}

/// The paper's cables, preloaded, on a link without dry friction whose motor is held by a
/// controller.
struct Bench {
  explicit Bench(double l_o)
      : model(spring_joint({0.339, 5.601, 0}, {0.0133, 1.0654, 0, 0}, 0)),
        curve_of((model.transmission = with_preload(paper_rig_low().transmission, l_o)), 0),
        range(working_range(curve_of, 40)) {
    model.rig.controller = Controller{};
    model.rig.controller->kp = 800;
    model.rig.controller->kd = 6;
  }

  /// The mean over one window of the residual of the link's equation with this model of the torque,
  /// in contact from its first row on. `settled`: the contact began long before.
  double mean_residual(const CurveModel& told, double load, double contact, bool settled,
                       Random& random) const {
    const int n = 50;
    SimulationInput input = quiet_input(n + 1, 1e-3);
    const double held = -(load + (settled ? contact : 0));
    input.theta0(0) = *curve_of.deflection_at(held);
    input.theta_ref = Eigen::ArrayXXd::Constant(n + 1, 1, input.theta0(0) + held / 800);
    input.tau_load = Eigen::ArrayXXd::Constant(n + 1, 1, load);
    input.link_disturbance = Eigen::ArrayXXd::Constant(n + 1, 1, contact);
    SimulationOptions options;
    options.closed_loop = true;
    const SimulationResult r = simulate(model, input, options);
    REQUIRE_FALSE(r.diverged_at.has_value());
    double sum = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto middle = [&](const Eigen::ArrayXXd& x) { return (x(i, 0) + x(i + 1, 0)) / 2; };
      const double inertial = 0.339 * (r.qd(i + 1, 0) - r.qd(i, 0)) / 1e-3;
      sum += inertial + 5.601 * middle(r.qd) - told.torque(middle(r.theta) - middle(r.q)) - load +
             0.3 * random.normal();
    }
    return sum / n;
  }

  Model model;
  JointCurve curve_of;
  WorkingRange range;
};

template <typename Mean>
double rate_above(double threshold, Mean mean) {
  int n = 0;
  for (int i = 0; i < kContacts; ++i) n += std::abs(mean()) > threshold;
  return static_cast<double>(n) / kContacts;
}

// Where the model is as wrong as it can be, both rates are met exactly: no alarm more, no contact
// less, and no margin that is not needed.
TEST_CASE("simulated contacts are detected at the stated rates where the model is worst",
          "[design]") {
  const Bench bench(0.00512);
  for (const CurveModel& told :
       {cables_themselves(bench.curve_of), linear_spring(bench.curve_of, bench.range)}) {
    const CollisionDetector d = detector(told.max_error);
    const CollisionThreshold t = collision_threshold(d);
    Random random(8101);
    // The residual's error is cables - model at this deflection; a contact of its sign is easy, one
    // against it the hardest.
    const double at = told.max_error > 0 ? told.at : 0.004;
    const double torque = bench.curve_of.torque(at);
    const double error = torque - told.torque(at);
    const double contact = error > 0 ? -t.torque : t.torque;
    const double alarms = rate_above(
        t.threshold, [&] { return bench.mean_residual(told, -torque, 0, true, random); });
    const double detected = rate_above(t.threshold, [&] {
      return bench.mean_residual(told, -torque - contact, contact, true, random);
    });
    std::printf(
        "    %s: error %.3g N m, contacts of %.4g N m; false alarms %.4f (0.02), detected "
        "%.4f (0.95)\n",
        told.name.c_str(), told.max_error, t.torque, alarms, detected);
    CHECK_THAT(alarms, WithinAbs(0.02, bound(0.02)));
    CHECK_THAT(detected, WithinAbs(0.95, bound(0.95)));
  }
}

// Anywhere in the working range, of either sign, and from the first moment on, the link swinging.
TEST_CASE("simulated contacts anywhere are detected at the stated rates or better", "[design]") {
  const Bench bench(0.00512);
  const CurveModel told = linear_spring(bench.curve_of, bench.range);
  const CollisionThreshold t = collision_threshold(detector(told.max_error));
  Random random(8102);
  // A sudden contact makes the link swing to twice its deflection: all within 40 N m.
  const double most = 40 - 2 * t.torque;
  REQUIRE(most > 15);
  const auto load = [&] { return most * (2 * random.uniform() - 1); };
  const auto sign = [&] { return random.uniform() < 0.5 ? -1.0 : 1.0; };
  const double alarms =
      rate_above(t.threshold, [&] { return bench.mean_residual(told, load(), 0, true, random); });
  const double detected = rate_above(t.threshold, [&] {
    return bench.mean_residual(told, load(), sign() * t.torque, false, random);
  });
  const double half = rate_above(t.threshold, [&] {
    return bench.mean_residual(told, load(), sign() * t.torque / 2, false, random);
  });
  std::printf("    anywhere: false alarms %.4f, detected %.4f, half the torque %.4f\n", alarms,
              detected, half);
  CHECK(alarms <= 0.02 + bound(0.02));
  CHECK(detected >= 0.95 - bound(0.95));
  CHECK(half < 0.95 - bound(0.95));
}

// 7 % of the variance over 0.2 s, the rest white: a threshold from white noise alone alarms far too
// often, one from measured means as often as it says.
TEST_CASE("slow noise alarms as often as it may", "[design]") {
  constexpr int kWindow = 50;
  const double keeps = std::exp(-1e-3 / 0.2), slow = 0.3 * std::sqrt(0.07);
  const double white = 0.3 * std::sqrt(0.93);
  Random random(8103);
  double state = 0;
  const auto row = [&] {
    state = keeps * state + std::sqrt(1 - keeps * keeps) * slow * random.normal();
    return state + white * random.normal();
  };
  WindowMeans means;
  Eigen::VectorXd rows(400000);
  std::vector<Eigen::Index> numbers(static_cast<std::size_t>(rows.size()));
  for (Eigen::Index i = 0; i < rows.size(); ++i) {
    rows(i) = row();
    numbers[static_cast<std::size_t>(i)] = i;
  }
  means.add(numbers, rows);
  CollisionDetector d = detector(0);
  const double as_white = collision_threshold(d).threshold;
  d.mean_noise = sd_of_mean(means.result(1e-3), d.window);
  const double measured = collision_threshold(d).threshold;
  int n_white = 0, n_measured = 0;
  constexpr int kWindows = 40000;
  for (int i = 0; i < kWindows; ++i) {
    double sum = 0;
    for (int k = 0; k < kWindow; ++k) sum += row();
    n_white += std::abs(sum / kWindow) > as_white ? 1 : 0;
    n_measured += std::abs(sum / kWindow) > measured ? 1 : 0;
  }
  std::printf("    false alarms: %.4f with a white threshold, %.4f with measured means (0.02)\n",
              n_white / double{kWindows}, n_measured / double{kWindows});
  // Windows are correlated over 8: 4 binomial sd of an eighth of them, and 3 % of the sd.
  CHECK_THAT(n_measured / double{kWindows}, WithinAbs(0.02, 0.012));
  CHECK(n_white / double{kWindows} > 0.1);
}

}  // namespace
