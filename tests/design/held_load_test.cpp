// Links under a constant load: closed forms of a pair, and the balance of torques of a finger.
#include "cablefit/design/loads/held_load.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "cablefit/design/curves/equilibrium_preload.hpp"
#include "cablefit/design/curves/joint_curve.hpp"
#include "tests/support/message.hpp"

namespace {

using namespace cablefit;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

constexpr double kExact = 1e-9;

Transmission pair_of(int order, const std::vector<double>& first,
                     const std::vector<double>& second) {
  Transmission pair = antagonist_pair(order);
  pair.cables[0].coefficients = first;
  pair.cables[1].coefficients = second;
  return pair;
}

HeldLoad under(const Transmission& transmission, double load) {
  return hold_load(transmission, Eigen::VectorXd::Constant(1, load));
}

// k = 1000 N m/rad each, u = 5 mrad: both taut up to 2 k u = 10 N m, x = T / 2k; beyond it cable 2
// is slack and k (u + x) = T. A load that turns the link back (negative) makes theta - q positive.
TEST_CASE("a linear pair sags as its taut cables let it", "[design]") {
  const double k = 1000, u = 0.005;
  const Transmission pair = with_preload(pair_of(1, {k}, {k}), u);
  for (const double torque : {2.0, 9.99, 10.01, 30.0})
    for (const double sign : {1.0, -1.0}) {
      INFO("load " << sign * torque);
      const HeldLoad held = under(pair, -sign * torque);
      const double x = torque <= 2 * k * u ? torque / (2 * k) : torque / k - u;
      CHECK_THAT(held.deflection(0), WithinRel(sign * x, kExact));
      CHECK_THAT(held.elongation(0), WithinRel(u + sign * x, 1e-7));
      CHECK_THAT(held.elongation(1), WithinRel(u - sign * x, 1e-7));
      CHECK_THAT(held.without_slack(0), WithinRel(sign * torque / (2 * k), kExact));
      CHECK_THAT(held.slack_share(), WithinAbs(1 - torque / (2 * k) / x, kExact));
      const Eigen::Index pulls = sign > 0 ? 0 : 1;
      CHECK_THAT(held.tension(pulls), WithinRel(k * (u + x), kExact));
    }
}

// Cable 1 alone: a (u + x) + b (u + x)^2 = T, by the quadratic formula.
TEST_CASE("a pair of order 2 sags as the quadratic formula says", "[design]") {
  const double a = 1400, b = 40000, u = 0.004, torque = 60;
  const Transmission pair = with_preload(pair_of(2, {a, b}, {a, b}), u);
  const HeldLoad held = under(pair, -torque);
  const double l = (-a + std::sqrt(a * a + 4 * b * torque)) / (2 * b);
  CHECK_THAT(held.deflection(0), WithinRel(l - u, kExact));
  CHECK(held.tension(1) == 0);
  // Both taut: a x 2 + b ((u + x)^2 - (u - x)^2) = (2 a + 4 b u) x.
  CHECK_THAT(under(pair, -5).deflection(0), WithinRel(5 / (2 * a + 4 * b * u), kExact));
  CHECK(under(pair, -5).slack_share() == Approx(0).margin(1e-9));
}

TEST_CASE("without a preload half of the sag of a linear pair is slack", "[design]") {
  const HeldLoad held = under(pair_of(1, {1000}, {1000}), 7);
  CHECK_THAT(held.deflection(0), WithinRel(-0.007, kExact));
  CHECK_THAT(held.slack_share(), WithinRel(0.5, kExact));
}

// With a gap of 2 and 1 mrad the link turns through it, then stretches a cable.
TEST_CASE("a gap is part of the sag", "[design]") {
  Transmission pair = pair_of(1, {1000}, {1000});
  pair.cables[0].initial_elongation = -0.002;
  pair.cables[1].initial_elongation = -0.001;
  CHECK_THAT(under(pair, -3).deflection(0), WithinRel(0.002 + 0.003, kExact));
  CHECK_THAT(under(pair, 3).deflection(0), WithinRel(-0.001 - 0.003, kExact));
}

/// Two joints and four cables, the second pair over both; a cam on the second link.
Transmission finger() {
  Transmission t = antagonist_pairs(2, 2);
  const double far[] = {0.01, -0.01, 0.006, -0.005}, near[] = {0.012, -0.01, 0.007, -0.008};
  for (std::size_t i = 0; i < 4; ++i) {
    Cable& cable = t.cables[i];
    cable.coefficients = {2e5, 3e7};
    cable.initial_elongation = 1e-3;
    cable.motor_map = {round_pulley(i < 2 ? far[i] : 0), round_pulley(i < 2 ? 0 : far[i])};
    cable.link_map = {round_pulley(near[i]), round_pulley(i < 2 ? 0 : near[i])};
  }
  return t;
}

// The elastic torques hold the load, whatever went slack; without a load nothing sags.
TEST_CASE("joints under load are in equilibrium", "[design]") {
  const Transmission t = finger();
  const Eigen::VectorXd theta = t.reference_theta() + t.encoder_zero();
  int n_slack = 0;
  for (const Eigen::Vector2d& load : {Eigen::Vector2d(0.5, -0.2), Eigen::Vector2d(-6, 4),
                                      Eigen::Vector2d(9, 9), Eigen::Vector2d(0, -5)}) {
    const HeldLoad held = hold_load(t, load);
    Eigen::VectorXd link, motor;
    t.torques(held.q, theta, link, motor);
    for (Eigen::Index j = 0; j < 2; ++j) CHECK_THAT(link(j), WithinAbs(-load(j), 1e-7));
    n_slack += held.tension.minCoeff() == 0;
  }
  CHECK(n_slack >= 3);
  CHECK(hold_load(t, Eigen::Vector2d::Zero()).deflection.norm() == Approx(0).margin(1e-12));
}

TEST_CASE("a load that no cable holds is refused", "[design]") {
  Transmission one = pair_of(1, {1000}, {0});
  CHECK(test::message_of([&] { (void)under(one, 3); }) ==
        "the cables do not hold a load of 3; give a smaller one, or cables that pull against it");
}

}  // namespace
