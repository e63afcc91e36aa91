// Linear cables, of which everything has a closed form.
//
// One joint in joint space, cable 1 with stiffness a and l_o = u, cable 2 with b and v, balanced:
// a u = b v. Torque on the motor at the deflection x, for -u < x < v (both taut)
//   a (u + x) - b (v - x) = (a + b) x,
// beyond v (cable 2 slack) a (u + x), beyond -u (cable 1 slack) -b (v - x).
// Closure: cable 2 goes slack at x = v with a (u + v), cable 1 at x = -u with -b (u + v); so the
// threshold is min(a, b) (u + v), and u = T / (min(a, b) (1 + a / b)) keeps closure up to T.
//
// a = b = k, u = v: for T > 2 k u the range ends at X = T / k - u. The spring of least squares is
//   K = int_0^X x tau / int_0^X x^2 = 3 (2 k u^3 / 3 + k ((X^3 - u^3) / 3 + u (X^2 - u^2) / 2)) /
//   X^3
//     = k (1 + 3/2 (u / X) - 1/2 (u / X)^3).
// Its error is (K - 2 k) x up to u and (K - k) x - k u beyond: linear on either side, so largest at
// u or at X.
#include <catch2/catch.hpp>
#include <cmath>

#include "cablefit/design/curves/curve_models.hpp"
#include "cablefit/design/curves/equilibrium_preload.hpp"
#include "cablefit/design/design_sweep.hpp"
#include "tests/support/message.hpp"

namespace {

using namespace cablefit;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

constexpr double kExact = 1e-10;  // relative; a few hundred roundings of 1e-16, roots to 1e-14

Transmission linear_cables(double a, double b) {
  Transmission pair = antagonist_pair(1);
  pair.cables[0].coefficients = {a};
  pair.cables[1].coefficients = {b};
  return pair;
}

Model model_of(const Transmission& transmission) {
  Model model;
  model.rig = default_rig();
  model.transmission = transmission;
  return model;
}

TEST_CASE("cables are balanced, and closure ends where the closed form says", "[design]") {
  for (const auto& [a, b, u] :
       {std::tuple{1800.0, 1800.0, 0.005}, std::tuple{1500.0, 2400.0, 0.004},
        std::tuple{3000.0, 900.0, 1e-6}}) {
    const Transmission pair = with_preload(linear_cables(a, b), u);
    const double v = a * u / b;
    CHECK_THAT(pair.cables[1].initial_elongation, WithinRel(v, kExact));
    const ClosureRange closure = closure_range(JointCurve(pair, 0));
    CHECK_THAT(closure.low, WithinRel(-u, kExact));
    CHECK_THAT(closure.high, WithinRel(v, kExact));
    CHECK_THAT(closure.torque_low, WithinRel(-b * (u + v), kExact));
    CHECK_THAT(closure.torque_high, WithinRel(a * (u + v), kExact));
    CHECK_THAT(closure.threshold(), WithinRel(std::min(a, b) * (u + v), kExact));
    CHECK(closure.cable_low == 0);
    CHECK(closure.cable_high == 1);
  }
  CHECK(closure_range(JointCurve(linear_cables(1800, 1800), 0)).threshold() == 0);
}

TEST_CASE("the smallest preload that keeps closure has a closed form", "[design]") {
  for (const auto& [a, b] : {std::pair{1800.0, 1800.0}, {1500.0, 2400.0}, {3000.0, 900.0}})
    for (const double torque : {0.1, 20.0, 400.0})
      CHECK_THAT(needed_preload(linear_cables(a, b), torque).l_o,
                 WithinRel(torque / (std::min(a, b) * (1 + a / b)), kExact));
}

TEST_CASE("the error of a linear spring on preloaded linear cables has a closed form", "[design]") {
  const double k = 1800, torque = 50;
  for (const double u : {1e-4, 0.002, 0.005, 0.009, 0.0138}) {
    INFO("l_o " << u);
    const Transmission pair = with_preload(linear_cables(k, k), u);
    const JointCurve curve(pair, 0);
    const WorkingRange range = working_range(curve, torque);
    const double end = torque / k - u, ratio = u / end;
    CHECK_THAT(range.high, WithinRel(end, kExact));
    CHECK_THAT(range.low, WithinRel(-end, kExact));
    const CurveModel line = linear_spring(curve, range);
    const double spring = k * (1 + 1.5 * ratio - 0.5 * std::pow(ratio, 3));
    CHECK_THAT(line.coefficients[0], WithinRel(spring, kExact));
    const double at_kink = std::abs((spring - 2 * k) * u);
    const double at_end = std::abs((spring - k) * end - k * u);
    CHECK_THAT(line.max_error, WithinRel(std::max(at_kink, at_end), 1e-9));
    CHECK_THAT(std::abs(line.at), WithinRel(at_kink > at_end ? u : end, 1e-6));
    // Piecewise linear is what they are: sums of a few hundred products of 50 N m.
    const CurveModel pieces = cables_of_order(curve, range, 1);
    CHECK_THAT(pieces.max_error, WithinAbs(0, 1e-9));
    CHECK_THAT(pieces.coefficients[0], WithinRel(k, 1e-9));
    CHECK_THAT(pieces.coefficients[1], WithinRel(k, 1e-9));
    // The static error: tau / K against the deflection, largest where the curve has its kink or
    // end.
    const double kink = std::abs(2 * k * u / spring - u), last = std::abs(torque / spring - end);
    CHECK_THAT(line.static_error, WithinRel(std::max(kink, last), 1e-9));
  }
}

// All taut up to the torque: the spring is the cables, K = a + b.
TEST_CASE("a preload that keeps closure makes linear cables a linear spring", "[design]") {
  const Transmission pair = with_preload(linear_cables(1500, 2400), 0.02);
  const JointCurve curve(pair, 0);
  const CurveModel line = linear_spring(curve, working_range(curve, 40));
  CHECK_THAT(line.coefficients[0], WithinRel(3900.0, kExact));
  CHECK_THAT(line.max_error, WithinAbs(0, 1e-9));
}

// Without preload each cable acts on its side, a x and b x, up to T / a and T / b:
// K = (a X^3 + b Y^3) / (X^3 + Y^3) with X = T / a, Y = T / b, and the errors at the ends are
// |K - a| X and |K - b| Y.
TEST_CASE("unlike cables without preload are no linear spring", "[design]") {
  const double a = 1500, b = 2400, torque = 40;
  const Transmission pair = linear_cables(a, b);
  const JointCurve curve(pair, 0);
  const CurveModel line = linear_spring(curve, working_range(curve, torque));
  const double x = std::pow(torque / a, 3), y = std::pow(torque / b, 3);
  const double spring = (a * x + b * y) / (x + y);
  CHECK_THAT(line.coefficients[0], WithinRel(spring, kExact));
  CHECK_THAT(line.max_error, WithinRel(std::max(std::abs(spring - a) * torque / a,
                                                std::abs(spring - b) * torque / b),
                                       1e-9));
}

// r times the radius: torque r f(r x), so the same cables at the same l_o are r^2 as stiff, go
// slack at 1/r of the deflection and r times the torque.
TEST_CASE("larger pulleys act squared on stiffness", "[design]") {
  const Transmission pair = with_preload(linear_cables(1500, 2400), 0.004);
  const Transmission larger = with_radii(pair, 1.3);
  const JointCurve before(pair, 0), after(larger, 0);
  CHECK_THAT(after.stiffness(0), WithinRel(1.69 * before.stiffness(0), kExact));
  CHECK_THAT(closure_range(after).high, WithinRel(closure_range(before).high / 1.3, kExact));
  CHECK_THAT(closure_range(after).threshold(),
             WithinRel(1.3 * closure_range(before).threshold(), kExact));
}

// mu N at the motor's pulleys: without load N = 2 k u, at a torque T within closure T + 2 b (v - x)
// = 2 k u still (a pair of equal linear cables exchanges tension), beyond it T alone.
TEST_CASE("friction and efficiency follow the tensions", "[design]") {
  const double k = 1800, u = 0.01, mu = 0.05;
  DesignOptions options;
  options.tension_friction = mu;
  for (const double torque : {30.0, 80.0}) {
    options.torque = torque;
    const DesignJoint joint = describe_joint(model_of(linear_cables(k, k)),
                                             with_preload(linear_cables(k, k), u), 0, options);
    REQUIRE(joint.friction.has_value());
    const double loaded = mu * std::max(2 * k * u, torque);
    CHECK_THAT(joint.friction->at_rest, WithinRel(mu * 2 * k * u, kExact));
    CHECK_THAT(joint.friction->driving, WithinRel(loaded, kExact));
    CHECK_THAT(joint.friction->efficiency_driving, WithinRel(torque / (torque + loaded), kExact));
    CHECK_THAT(joint.friction->efficiency_driven, WithinRel((torque - loaded) / torque, kExact));
  }
}

TEST_CASE("what cannot be preloaded is told", "[design]") {
  Transmission pair = linear_cables(1500, 2400);
  pair.cables[1].motor_map = pair.cables[1].link_map = {round_pulley(1)};
  CHECK(test::message_of([&] { (void)with_preload(pair, 0.01); }) ==
        "no tensions of these cables are in equilibrium, (8c): they cannot be "
        "preloaded; route them so that each joint is pulled in both directions (n "
        "joints need n + 1 cables or more), or check the signs of the radii");
  CHECK(test::message_of([&] { (void)with_preload(linear_cables(1500, 0), 0.01); }) ==
        "cable '2' does not reach a force of 15 N; give it coefficients that grow with "
        "its elongation");
}

// Cables with K1 > 0 > K2 pull most, K1^2/(-4 K2), at l = K1/(-2 K2). A pair of them, alike and
// wound on unit pulleys, carries at most that when one is stretched so far and the other just slack
// (deflection l): f(l_o + l) - f(l_o - l) = torque with l = l_o at the threshold, f(2 l_o).
TEST_CASE("cables that give way still have a preload that is enough", "[design]") {
  Transmission pair = linear_cables(1500, 1500);
  for (Cable& cable : pair.cables) {
    cable.order = 2;
    cable.coefficients = {1500, -15000};  // 37.5 N at 0.05
  }
  const double torque = 30, l_o = 0.05 * (1 - std::sqrt(1 - torque / 37.5)) / 2;
  CHECK_THAT(needed_preload(pair, torque).l_o, WithinRel(l_o, 1e-9));
  const PreloadSearch none = needed_preload(pair, 40);
  CHECK(std::isnan(none.l_o));
  CHECK(none.searched_to > l_o);
}

}  // namespace
