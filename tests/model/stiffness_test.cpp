// Stiffness matrices against central differences of the torques, which the library's other tests
// hold against the paper's (8), and against closed forms of linear cables on round pulleys.
#include "cablefit/model/stiffness.hpp"

#include <catch2/catch.hpp>

namespace {

using namespace cablefit;

using Radii = std::vector<DisplacementMap>;

Cable cable_of(const std::string& name, Radii motor, Radii link, std::vector<double> k,
               double l_o) {
  Cable cable;
  cable.name = name;
  cable.law = &find_cable_law("polynomial");
  cable.order = static_cast<int>(k.size());
  cable.coefficients = std::move(k);
  cable.motor_map = std::move(motor);
  cable.link_map = std::move(link);
  cable.initial_elongation = l_o;
  return cable;
}

Radii round(std::vector<double> radii) {
  Radii maps;
  for (const double r : radii) maps.push_back(round_pulley(r));
  return maps;
}

/// Radius r + s x.
DisplacementMap growing(double r, double s) {
  DisplacementMap map;
  map.kind = &find_map_kind("polynomial");
  map.parameters.coefficients = {r, s};
  return map;
}

/// Two joints, two antagonist pairs; the second pair passes the first joint.
Transmission two_joints() {
  Transmission t;
  t.n_joints = 2;
  t.cables = {cable_of("a", round({0.03, 0}), round({0.03, 0}), {2e5, 1e7}, 2e-3),
              cable_of("b", round({-0.03, 0}), round({-0.03, 0}), {2e5, 1e7}, 2e-3),
              cable_of("c", round({0, 0.02}), round({0.01, 0.02}), {1e5, 2e7}, 3e-3),
              cable_of("d", round({0, -0.02}), round({-0.01, -0.02}), {1e5, 2e7}, 3e-3)};
  return t;
}

/// A finger of three joints with n + 1 tendons, one pulley of it growing.
Transmission finger() {
  Transmission t;
  t.n_joints = 3;
  t.theta_0 = Eigen::Vector3d(0.01, -0.02, 0.03);
  t.cables = {
      cable_of("1", round({0.01, 0, 0}), round({0.01, 0.008, 0.006}), {1e5}, 2e-3),
      cable_of("2", round({0, 0.009, 0}), round({-0.01, 0.007, 0.006}), {8e4, 1e7}, 2e-3),
      cable_of("3", round({0, 0, 0.008}), round({0, -0.008, 0.005}), {9e4, 2e7, 1e9}, 2e-3),
      cable_of("4", {round_pulley(-0.01), round_pulley(-0.009), growing(-0.008, 0.001)},
               {growing(-0.01, 0.002), round_pulley(-0.007), round_pulley(-0.006)}, {1.2e5}, 3e-3)};
  return t;
}

/// As two_joints(), with levers that depend on both angles.
Transmission two_angles() {
  Transmission t = two_joints();
  PairMap pair{&find_pair_map_kind("polynomial"), {}, {0, 1}};
  pair.parameters.values.resize(3, 2);
  pair.parameters.values << 0, 0.001, 0.002, 0.02, 0.01, -0.03;
  t.cables[2].link_pairs = {pair};
  pair.joints = {1, 0};
  t.cables[3].link_pairs = t.cables[0].motor_pairs = {pair};
  t.cables[3].motor_pairs = {pair, pair};
  return t;
}

/// Column k: change of the torque with position k, by central differences.
template <typename Torque>
Eigen::MatrixXd differences(const Eigen::VectorXd& at, Torque torque) {
  constexpr double kStep = 1e-6;
  Eigen::MatrixXd slope(at.size(), at.size());
  for (Eigen::Index k = 0; k < at.size(); ++k) {
    const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(at.size(), k);
    slope.col(k) = (torque(at + step) - torque(at - step)) / (2 * kStep);
  }
  return slope;
}

Eigen::VectorXd link_torque(const Transmission& t, const Eigen::VectorXd& q,
                            const Eigen::VectorXd& theta) {
  Eigen::VectorXd link, motor;
  t.torques(q, theta, link, motor);
  return link;
}

Eigen::VectorXd motor_torque(const Transmission& t, const Eigen::VectorXd& q,
                             const Eigen::VectorXd& theta) {
  Eigen::VectorXd link, motor;
  t.torques(q, theta, link, motor);
  return motor;
}

/// Differences of torques of 10 N m: rounding 1e-15 over 2e-6, and the third derivative (at most
/// 1e6) times 1e-12 / 6; both far below 1e-5.
void check_slopes(const Transmission& t, const Eigen::VectorXd& q, const Eigen::VectorXd& theta) {
  const StiffnessMatrices k = stiffness_matrices(t, q, theta);
  const auto near = [](const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
    return (a - b).cwiseAbs().maxCoeff() < 1e-5;
  };
  CHECK(near(k.link_q, differences(q, [&](const auto& x) { return link_torque(t, x, theta); })));
  CHECK(near(k.motor_q, differences(q, [&](const auto& x) { return motor_torque(t, x, theta); })));
  CHECK(
      near(k.link_theta, differences(theta, [&](const auto& x) { return link_torque(t, q, x); })));
  CHECK(near(k.motor_theta,
             differences(theta, [&](const auto& x) { return motor_torque(t, q, x); })));
  const Eigen::MatrixXd hessian = k.energy_hessian();
  CHECK(near(hessian, hessian.transpose()));
}

TEST_CASE("the matrices are the slopes of the torques", "[model]") {
  check_slopes(two_joints(), Eigen::Vector2d(0.1, -0.05), Eigen::Vector2d(0.12, -0.02));
  check_slopes(two_angles(), Eigen::Vector2d(0.1, -0.05), Eigen::Vector2d(0.12, -0.02));
  check_slopes(finger(), Eigen::Vector3d(0.2, -0.1, 0.3), Eigen::Vector3d(0.22, -0.15, 0.28));
  check_slopes(finger(), Eigen::Vector3d(0.2, -0.1, 0.3), Eigen::Vector3d(0.5, 0.3, -0.4));
}

// Of linear, taut cables of one stiffness k on equal pulleys: every block is +-k R R^T.
TEST_CASE("linear cables on round pulleys have the closed form", "[model]") {
  Transmission t = two_joints();
  Eigen::MatrixXd r(2, 4);
  r << 0.03, -0.03, 0, 0, 0, 0, 0.02, -0.02;
  for (Cable& cable : t.cables) {
    cable.order = 1;
    cable.coefficients = {2e5};
    cable.link_map = cable.motor_map;
  }
  const Eigen::MatrixXd expected = 2e5 * r * r.transpose();  // diag(360, 160)
  const StiffnessMatrices k =
      stiffness_matrices(t, Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero());
  CHECK((k.motor_theta - expected).norm() < 1e-9);
  CHECK((k.link_theta - expected).norm() < 1e-9);
  CHECK((k.motor_q + expected).norm() < 1e-9);
  CHECK((k.link_q + expected).norm() < 1e-9);
  const StiffnessModes modes = stiffness_modes(k);
  CHECK((modes.motors_free - Eigen::Vector2d(160, 360)).norm() < 1e-9);
  CHECK(modes.passive);
  // Both joints turned, so that b and d are slack: half of it.
  const Eigen::Vector2d turned(0.2, 0.4);
  const StiffnessMatrices half = stiffness_matrices(t, Eigen::Vector2d::Zero(), turned);
  CHECK((half.motor_theta - expected / 2).norm() < 1e-9);
  CHECK(cable_stiffnesses(t, Eigen::Vector2d::Zero(), turned) == Eigen::Vector4d(2e5, 0, 2e5, 0));
}

// k = 1e5 N/m - 4e7 N/m^2 * 2 * 2 mm = -6e4 N/m: such a cable gives way as it is stretched.
TEST_CASE("cables that give way are not passive", "[model]") {
  Transmission t = two_joints();
  t.cables[0].coefficients = t.cables[1].coefficients = {1e5, -4e7};
  const StiffnessModes modes =
      stiffness_modes(stiffness_matrices(t, Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()));
  CHECK_FALSE(modes.passive);
  CHECK(std::abs(modes.motors_free(0) + 2 * 0.03 * 0.03 * 6e4) < 1e-9);
}

TEST_CASE("a reduced spring couples motor and link by its reduction", "[model]") {
  Transmission spring;
  spring.linear_stiffness = Eigen::VectorXd::Constant(1, 700);
  spring.linear_reduction = Eigen::VectorXd::Constant(1, 2);
  const auto at = [](double x) { return Eigen::VectorXd::Constant(1, x).eval(); };
  const StiffnessMatrices k = stiffness_matrices(spring, at(0.1), at(0.3));
  CHECK(k.motor_theta(0, 0) == 700);
  CHECK(k.motor_q(0, 0) == -1400);
  CHECK(k.link_theta(0, 0) == 1400);
  CHECK(k.link_q(0, 0) == -2800);
}

}  // namespace
