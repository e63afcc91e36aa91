// Force closure and disclosure, and the preload's equilibrium.
#include "cablefit/model/modes.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "cablefit/base/json/json_document.hpp"
#include "cablefit/model/rig.hpp"

namespace {

using namespace cablefit;
using Eigen::VectorXd;

/// The shipped high preload: data/README.md, made by a simulator of its own.
Transmission high_preload() {
  Transmission pair = antagonist_pair(2);
  pair.cables[0].coefficients = {1367.7, 37844.1};
  pair.cables[1].coefficients = {1575.3, 29357.2};
  pair.cables[0].initial_elongation = 0.00512;
  pair.cables[1].initial_elongation = 0.004668802;
  return pair;
}

VectorXd one(double value) { return VectorXd::Constant(1, value); }

TEST_CASE("cables of the shipped rig go slack where its README says") {
  const std::vector<SlackPoint> points = slack_points(high_preload(), -0.045, 0.045);
  REQUIRE(points.size() == 2);
  CHECK(points[0].cable == 0);
  CHECK(std::abs(points[0].deflection + 0.00512) < 1e-13);  // 1e-12 of the range
  CHECK(std::abs(points[0].motor + 18.23) < 0.005);         // as printed
  CHECK_FALSE(points[0].slack_above);
  CHECK(points[1].cable == 1);
  CHECK(std::abs(points[1].deflection - 0.004668802) < 1e-13);
  CHECK(std::abs(points[1].motor - 17.01) < 0.005);
  CHECK(points[1].link == points[1].motor);
  CHECK(points[1].slack_above);
  CHECK(slack_points(high_preload(), -0.004, 0.004).empty());
  Transmission loose = high_preload();  // both slack between the two points
  loose.cables[0].initial_elongation = -2.96e-6;
  loose.cables[1].initial_elongation = -2.29e-6;
  for (const SlackPoint& point : slack_points(loose, -0.045, 0.045)) CHECK(point.motor == 0);
  CHECK(is_preloaded(high_preload()));
  CHECK_FALSE(is_preloaded(antagonist_pair(2)));
}

TEST_CASE("slack points count from the encoder zero and the reference pose") {
  Transmission pair = high_preload();
  pair.theta_0 = one(0.7);
  CHECK(std::abs(slack_points(pair, -0.045, 0.045)[0].motor + 18.23) < 0.005);
  // A link that is twice as large, held at 0.2: l = theta - 2 q + l_o - (0.4 - 0.4).
  for (Cable& cable : pair.cables) cable.link_map = round_pulleys(2 * cable.link_radii(one(0)));
  set_reference(pair, {one(0.2), one(0.2)});
  const std::vector<SlackPoint> points = slack_points(pair, -0.045, 0.045);
  CHECK(std::abs(points[0].deflection + 0.00512) < 1e-13);
  CHECK(points[0].link == Approx(2 * points[0].motor).epsilon(1e-12));
}

TEST_CASE("slack points are found where pulleys are not round") {
  // Radius 1 + 20 x: l = x + 10 x^2 + l_o, slack between its two roots.
  const Rig rig = parse_rig(parse_json(
      R"({"cables": [{"name": "a", "link_radius": 1, "initial_elongation": 0.02,
          "motor_radius": {"type": "polynomial", "coefficients": [1, 20]}}]})",
      "rig.json"));
  Transmission transmission = rig.transmission;
  transmission.cables[0].coefficients = {1000, 0};
  const std::vector<SlackPoint> points = slack_points(transmission, -0.2, 0.2);
  REQUIRE(points.size() == 2);
  const double root = std::sqrt(1 - 4 * 10 * 0.02);
  CHECK(std::abs(points[0].deflection - (-1 - root) / 20) < 4e-13);  // 1e-12 of the range
  CHECK(points[0].slack_above);
  CHECK(std::abs(points[1].deflection - (-1 + root) / 20) < 4e-13);
  CHECK_FALSE(points[1].slack_above);
}

TEST_CASE("samples are labelled cable by cable") {
  const Transmission pair = high_preload();
  const VectorXd q = VectorXd::Constant(4, 0.1);
  VectorXd theta(4);
  theta << 0.1, 0.1 + 0.0046, 0.1 + 0.0047, 0.1 - 0.0052;
  const TautTable taut = taut_cables(pair, q, theta);
  TautTable expected(4, 2);
  expected << true, true, true, true, true, false, false, true;
  CHECK((taut == expected).all());
  CHECK(modes(taut) ==
        std::vector<Mode>{Mode::closure, Mode::closure, Mode::disclosure, Mode::disclosure});
  CHECK(to_string(Mode::closure) == "closure");
  CHECK(to_string(Mode::disclosure) == "disclosure");
}

TEST_CASE("a map over the positions of one joint has the modes of its poses") {
  Transmission arm = antagonist_pairs(2, 1);
  for (Cable& cable : arm.cables) cable.initial_elongation = 0.01;
  arm.cables[2].initial_elongation = -0.01;
  const VectorXd q = VectorXd::LinSpaced(7, -0.03, 0.03), theta = VectorXd::LinSpaced(5, 0, 0.04);
  const ReferencePose pose{Eigen::Vector2d(0, 0.1), Eigen::Vector2d(0, 0.15)};
  const ModeMap map = mode_map(arm, 0, q, theta, pose);
  REQUIRE(map.elongation.size() == 4);
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    for (Eigen::Index j = 0; j < theta.size(); ++j) {
      CHECK(map.taut(0, i, j) == (theta[j] - q[i] + 0.01 > 0));
      CHECK(map.taut(1, i, j) == (q[i] - theta[j] + 0.01 > 0));
      CHECK(map.taut(2, i, j));        // 0.15 - 0.1 - 0.01
      CHECK_FALSE(map.taut(3, i, j));  // 0.1 - 0.15 + 0.01
      CHECK(map.mode(i, j) == Mode::disclosure);
    }
  }
  ReferencePose balanced = pose;
  balanced.theta[1] = 0.1;
  arm.cables[2].initial_elongation = 0.01;
  const ModeMap closed = mode_map(arm, 0, q, theta, balanced);
  CHECK(closed.mode(3, 0) == Mode::closure);     // q = 0, theta = 0
  CHECK(closed.mode(0, 4) == Mode::disclosure);  // q = -0.03, theta = 0.04
}

TEST_CASE("a balanced preload makes no torques, (8c)") {
  // The initial elongations are printed to 1 nrad, and cables are 1700 N m/rad stiff there.
  const PreloadTorques balanced = preload_torques(high_preload());
  CHECK(std::abs(balanced.link[0]) < 1e-6);
  CHECK(std::abs(balanced.motor[0]) < 1e-6);
  Transmission pair = high_preload();
  pair.cables[1].initial_elongation = 0;
  pair.theta_0 = one(0.3);
  set_reference(pair, {one(0.1), one(-0.4)});
  const double cable_1 = 1367.7 * 0.00512 + 37844.1 * 0.00512 * 0.00512;
  CHECK(preload_torques(pair).motor[0] == Approx(cable_1).epsilon(1e-9));
}

TEST_CASE("linear cables with preload are the paper's Fig. 4") {
  Transmission pair = parse_rig(parse_json(R"({"cables": [
        {"name": "1", "motor_radius": 0.05, "link_radius": 0.05, "law": "linear",
         "initial_elongation": 0.001},
        {"name": "2", "motor_radius": -0.05, "link_radius": -0.05, "law": "linear",
         "initial_elongation": 0.001}]})",
                                           "rig.json"))
                          .transmission;
  for (Cable& cable : pair.cables) cable.coefficients = {4e5};
  const double k = 4e5 * 0.05 * 0.05;  // N m/rad of one cable
  const auto torque = [&](double phi) {
    VectorXd link, motor;
    pair.torques(one(0.3), one(0.3 + phi), link, motor);
    return link[0];
  };
  // Both cables within l_o/r = 20 mrad, one beyond.
  CHECK(torque(0.015) == Approx(2 * k * 0.015).epsilon(1e-9));
  CHECK(torque(-0.015) == Approx(-2 * k * 0.015).epsilon(1e-9));
  CHECK(torque(0.03) == Approx(k * (0.03 + 0.02)).epsilon(1e-9));
  CHECK(torque(-0.03) == Approx(-k * (0.03 + 0.02)).epsilon(1e-9));
  const std::vector<SlackPoint> points = slack_points(pair, -0.05, 0.05);
  REQUIRE(points.size() == 2);
  CHECK(points[0].deflection == Approx(-0.02).epsilon(1e-9));
  CHECK(points[1].motor == Approx(2 * k * 0.02).epsilon(1e-9));
}

}  // namespace
