#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "cablefit/base/json/json_document.hpp"
#include "cablefit/model/rig.hpp"

namespace {

using namespace cablefit;
using Eigen::VectorXd;

/// Two joints and three cables, the third coupling both.
Transmission coupled_arm() {
  Transmission arm;
  arm.n_joints = 2;
  arm.theta_0 = VectorXd::Constant(2, 0.01);
  const double radii[3][4] = {
      {0.05, 0.0, 0.06, 0.0}, {-0.05, 0.0, -0.06, 0.0}, {0.02, -0.04, 0.03, -0.05}};
  for (const auto& r : radii) {
    Cable cable;
    cable.name = std::to_string(arm.cables.size() + 1);
    cable.law = &find_cable_law("polynomial");
    cable.order = 3;
    cable.coefficients = {4e4, 2e5, 1e6};
    cable.initial_elongation = 0.004;
    cable.motor_map = round_pulleys(Eigen::Vector2d(r[0], r[1]));
    cable.link_map = round_pulleys(Eigen::Vector2d(r[2], r[3]));
    arm.cables.push_back(cable);
  }
  return arm;
}

Transmission two_springs() {
  Transmission springs;
  springs.n_joints = 2;
  springs.theta_0 = VectorXd::Constant(2, -0.02);
  springs.linear_stiffness = Eigen::Vector2d(1819.2, 300);
  return springs;
}

TEST_CASE("the elastic torques are the gradient of the elastic energy, (1)") {
  const auto transmission = GENERATE(coupled_arm(), two_springs());
  std::mt19937 engine(4);
  std::uniform_real_distribution<double> uniform(-0.1, 0.1);
  constexpr double kStep = 1e-5;
  for (int trial = 0; trial < 20; ++trial) {
    const VectorXd q = VectorXd::NullaryExpr(2, [&] { return uniform(engine); });
    const VectorXd theta = VectorXd::NullaryExpr(2, [&] { return uniform(engine); });
    VectorXd link, motor;
    transmission.torques(q, theta, link, motor);
    for (Eigen::Index k = 0; k < 2; ++k) {
      const VectorXd step = kStep * VectorXd::Unit(2, k);
      const double by_q =
          (transmission.energy(q + step, theta) - transmission.energy(q - step, theta)) /
          (2 * kStep);
      const double by_theta =
          (transmission.energy(q, theta + step) - transmission.energy(q, theta - step)) /
          (2 * kStep);
      // Torques reach 100 N m. Central difference: h^2/6 U''' ~ 1e-8 (no cable of these poses goes
      // slack within a step); rounding of U (10 J): 1e-15 * 10 / 1e-5 = 1e-9.
      CHECK(std::abs(link[k] + by_q) < 1e-7);
      CHECK(std::abs(motor[k] - by_theta) < 1e-7);
    }
  }
}

TEST_CASE("the paper's pair of cables is (30)") {
  Transmission pair = antagonist_pair(2);
  REQUIRE(pair.cables.size() == 2);
  CHECK(pair.cables[0].name == "1");
  CHECK(pair.cables[1].name == "2");
  pair.cables[0].coefficients = {1367.7, 37844.1};
  pair.cables[1].coefficients = {1575.3, 29357.2};
  const auto torque = [&](double phi) {
    VectorXd link, motor;
    pair.torques(VectorXd::Constant(1, 0.2), VectorXd::Constant(1, 0.2 + phi), link, motor);
    CHECK(link == motor);
    return link[0];
  };
  CHECK(torque(0.03) == Approx(1367.7 * 0.03 + 37844.1 * 0.0009).epsilon(1e-12));
  CHECK(torque(-0.03) == Approx(-1575.3 * 0.03 - 29357.2 * 0.0009).epsilon(1e-12));
  CHECK(torque(0) == 0);
}

TEST_CASE("several joints have a pair each, numbered on") {
  const Transmission arm = antagonist_pairs(2, 1);
  REQUIRE(arm.cables.size() == 4);
  CHECK(arm.cables[2].name == "3");
  const Eigen::Vector2d anywhere(0.3, -0.2);
  CHECK(arm.cables[2].motor_radii(anywhere) == Eigen::Vector2d(0, 1));
  CHECK(arm.cables[3].link_radii(anywhere) == Eigen::Vector2d(0, -1));
}

TEST_CASE("an empty encoder zero is 0") {
  Transmission pair = antagonist_pair(1);
  pair.theta_0.resize(0);
  CHECK(pair.elongations(VectorXd::Zero(1), VectorXd::Ones(1)) == Eigen::Vector2d(1, -1));
}

TEST_CASE("elongations count from the reference pose") {
  Transmission arm = coupled_arm();
  const Eigen::Vector2d q_o(0.3, -0.2), theta_o(0.5, 0.1);
  set_reference(arm, {q_o, theta_o});
  const VectorXd there = theta_o + arm.theta_0;
  // Sums of a few products of about 0.01: rounding 1e-17.
  CHECK((arm.elongations(q_o, there).array() - 0.004).abs().maxCoeff() < 1e-16);
  const Eigen::Vector2d step(0.01, -0.02);
  const VectorXd l = arm.elongations(q_o, there + step);
  CHECK(l[2] - 0.004 == Approx(0.02 * 0.01 + 0.04 * 0.02).epsilon(1e-12));
}

TEST_CASE("elongations count from position 0 where no other pose is given") {
  const Rig rig = parse_rig(parse_json(R"({"cables": [{"name": "a", "motor_radius": 0.02,
    "link_radius": {"type": "table", "angle": [-1, 1], "displacement": [0.03, 0.05]},
    "initial_elongation": 0.001}]})",
                                       "rig.json"));
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(1);
  CHECK(std::abs(rig.transmission.elongations(zero, zero)(0) - 0.001) < 1e-17);
}

TEST_CASE("elastic parameters are named as in results") {
  Cable cable;
  cable.name = "left";
  CHECK(coefficient_name(cable, 1, true) == "k[left]_1");
  CHECK(elongation_name(cable) == "l_o[left]");
  CHECK(coefficient_name(antagonist_pair(1).cables[1], 0, false) == "K2_0");
  const CableLaw& polynomial = find_cable_law("polynomial");
  CHECK(coefficient_unit(polynomial, 0, false) == "N m/rad");
  CHECK(coefficient_unit(polynomial, 1, false) == "N m/rad^2");
  CHECK(coefficient_unit(polynomial, 0, true) == "N/m");
  CHECK(coefficient_unit(polynomial, 1, true) == "N/m^2");
  CHECK(coefficient_unit(find_cable_law("strand"), 3, true) == "N/m");
}

}  // namespace
