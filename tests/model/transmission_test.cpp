#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "cablefit/model/cables.hpp"

namespace {

using namespace cablefit;
using Eigen::VectorXd;

/// Elastic energy: the integral of every cable's force, by the trapezoidal rule on a fine grid.
double cable_energy(const Cable& cable, double l) {
  if (l <= 0) return 0;
  constexpr int kSteps = 4000;
  double sum = 0.5 * cable.force(l);
  for (int i = 1; i < kSteps; ++i) sum += cable.force(l * i / kSteps);
  return sum * l / kSteps;
}

double energy(const Transmission& transmission, const VectorXd& q, const VectorXd& theta) {
  if (transmission.cables.empty()) {
    const VectorXd phi = theta - transmission.theta_0 - q;
    return 0.5 * phi.dot(transmission.linear_stiffness.cwiseProduct(phi));
  }
  const VectorXd l = transmission.elongations(q, theta);
  double sum = 0;
  for (Eigen::Index i = 0; i < l.size(); ++i) {
    sum += cable_energy(transmission.cables[static_cast<std::size_t>(i)], l[i]);
  }
  return sum;
}

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
    cable.motor_radius = Eigen::Vector2d(r[0], r[1]);
    cable.link_radius = Eigen::Vector2d(r[2], r[3]);
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
          (energy(transmission, q + step, theta) - energy(transmission, q - step, theta)) /
          (2 * kStep);
      const double by_theta =
          (energy(transmission, q, theta + step) - energy(transmission, q, theta - step)) /
          (2 * kStep);
      // Torques reach 100 N m. Central difference: h^2/6 U''' ~ 1e-8; quadrature: 1/(12 4000^2)
      // of the nonlinear part ~ 1e-6; rounding of U (10 J): 1e-15 * 10 / 1e-5 = 1e-9.
      CHECK(std::abs(link[k] + by_q) < 5e-6);
      CHECK(std::abs(motor[k] - by_theta) < 5e-6);
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
  CHECK(arm.cables[2].motor_radius == Eigen::Vector2d(0, 1));
  CHECK(arm.cables[3].link_radius == Eigen::Vector2d(0, -1));
}

TEST_CASE("an empty encoder zero is 0") {
  Transmission pair = antagonist_pair(1);
  pair.theta_0.resize(0);
  CHECK(pair.elongations(VectorXd::Zero(1), VectorXd::Ones(1)) == Eigen::Vector2d(1, -1));
}

TEST_CASE("elastic parameters are named as in results") {
  Cable cable;
  cable.name = "left";
  CHECK(coefficient_name(cable, 1, true) == "k[left]_1");
  CHECK(elongation_name(cable) == "l_o[left]");
  cable.name = "2";
  CHECK(coefficient_name(cable, 0, false) == "K2_0");
  CHECK(coefficient_unit(0, false) == "N m/rad");
  CHECK(coefficient_unit(1, false) == "N m/rad^2");
  CHECK(coefficient_unit(0, true) == "N/m");
  CHECK(coefficient_unit(1, true) == "N/m^2");
}

}  // namespace
