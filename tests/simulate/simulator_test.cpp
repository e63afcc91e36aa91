// The rest of the interface: closed loop, several joints, blocked link, divergence, gap.
#include "cablefit/simulate/simulator.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "cablefit/base/error.hpp"
#include "tests/simulate/benches.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

Controller pd(double kp, double kd) {
  Controller controller;
  controller.kp = kp;
  controller.kd = kd;
  return controller;
}

SimulationOptions closed_loop() {
  SimulationOptions options;
  options.closed_loop = true;
  return options;
}

TEST_CASE("a PD controller holds its reference", "[simulate]") {
  Model model = paper_rig_low();
  model.rig.controller = pd(800, 6);
  model.rig.controller->limit = 250;
  SimulationInput input = quiet_input(1500, 1e-3);
  input.theta_ref = Eigen::ArrayXXd::Constant(1500, 1, 0.2);
  const SimulationResult result = simulate(model, input, closed_loop());
  // kp times the error that remains is held by dry friction and the offset.
  CHECK(std::abs(result.theta(1499, 0) - 0.2) <= (2.778 + 3.274 + 0.0286) / 800);
  CHECK(result.thetad(1499, 0) == 0);
  CHECK(result.tau(0, 0) == Approx(800 * 0.2).epsilon(1e-12));
  CHECK(result.tau.abs().maxCoeff() <= 250);
}

TEST_CASE("each joint has its own controller", "[simulate]") {
  const Controller weak = pd(200, 2), strong = pd(800, 6);
  Model one = spring_joint({0.3, 5, 3}, {0.01, 1, 2, 0}, 2000);
  SimulationInput input = quiet_input(300, 1e-3);
  input.theta_ref = Eigen::ArrayXXd::Constant(300, 1, 0.2);
  Model two = one;
  two.rig.joints = {"1", "2"};
  two.joints.push_back(one.joints[0]);
  two.transmission.n_joints = 2;
  two.transmission.theta_0 = Eigen::Vector2d::Zero();
  two.transmission.linear_stiffness = Eigen::Vector2d(2000, 2000);
  two.rig.controller = controller_of({weak, strong});
  SimulationInput both = quiet_input(300, 1e-3, 2);
  both.theta_ref = Eigen::ArrayXXd::Constant(300, 2, 0.2);
  const SimulationResult result = simulate(two, both, closed_loop());
  for (const Eigen::Index joint : {0, 1}) {
    one.rig.controller = joint == 0 ? weak : strong;
    const SimulationResult alone = simulate(one, input, closed_loop());
    CHECK((result.theta.col(joint) == alone.theta.col(0)).all());
    CHECK((result.tau.col(joint) == alone.tau.col(0)).all());
  }
}

TEST_CASE("the controller sees theta in steps of the encoder", "[simulate]") {
  Model model = rigid_drive({0.1, 1, 2, 0});
  model.rig.controller = pd(100, 0);
  model.rig.sensors["theta"].quantum = 0.01;
  SimulationInput input = quiet_input(2, 1e-3);
  input.theta0[0] = 0.0449;  // reads 0.04
  input.theta_ref = Eigen::ArrayXXd::Constant(2, 1, 0.05);
  CHECK(simulate(model, input, closed_loop()).tau(0, 0) == Approx(1).epsilon(1e-12));
  model.rig.sensors["theta1"].quantum = 0.02;  // the joint's own counts
  CHECK(simulate(model, input, closed_loop()).tau(0, 0) == Approx(1).epsilon(1e-12));
  model.rig.sensors["theta1"].quantum = 0.03;  // reads 0.03
  CHECK(simulate(model, input, closed_loop()).tau(0, 0) == Approx(2).epsilon(1e-12));
}

TEST_CASE("the controller differentiates by backward differences, from the initial speed",
          "[simulate]") {
  Model model = rigid_drive({1e9, 0, 0, 0});  // moves on whatever the torque
  model.rig.controller = pd(0, 3);
  SimulationInput input = quiet_input(4, 1e-3);
  input.thetad0[0] = 0.5;
  input.theta_ref = Eigen::ArrayXXd(4, 1);
  input.theta_ref.col(0) << 0, 0.002, 0.004, 0.004;
  const SimulationResult result = simulate(model, input, closed_loop());
  CHECK(result.tau(0, 0) == Approx(3 * (2 - 0.5)).epsilon(1e-9));
  CHECK(result.tau(1, 0) == Approx(3 * (2 - 0.5)).epsilon(1e-9));
  CHECK(result.tau(3, 0) == Approx(3 * (0 - 0.5)).epsilon(1e-9));
}

TEST_CASE("the controller may be faster or slower than the log", "[simulate]") {
  Model model = rigid_drive({0.1, 3, 0, 0});
  model.rig.controller = pd(200, 5);
  SimulationInput input = quiet_input(400, 1e-3);
  input.theta_ref = Eigen::ArrayXXd::Constant(400, 1, 0.1);
  for (const double period : {0.25e-3, 0.3e-3, 1e-3, 2e-3, 4e-3}) {
    INFO("period " << period);
    model.rig.controller->period = period;
    const SimulationResult result = simulate(model, input, closed_loop());
    CHECK(std::abs(result.theta(399, 0) - 0.1) < 1e-3);
    if (period == 2e-3) CHECK(result.tau(2, 0) == result.tau(3, 0));
  }
}

TEST_CASE("a closed loop needs a controller", "[simulate]") {
  SimulationInput input = quiet_input(2, 1e-3);
  input.theta_ref = input.tau;
  CHECK_THROWS_WITH(simulate(rigid_drive({1, 0, 0, 0}), input, closed_loop()),
                    "no controller for a closed-loop simulation; add \"controller\" to the rig "
                    "file, or replay the measured torque");
}

TEST_CASE("uncoupled joints move as each does alone", "[simulate]") {
  Model arm = paper_rig_low();
  arm.rig.joints = {"1", "2"};
  arm.joints.push_back({base_effects_with(Side::link, {0.2, 2, 1}),
                        base_effects_with(Side::motor, {0.02, 1, 1.5, 0.1})});
  arm.transmission = antagonist_pairs(2, 2);
  for (Cable& cable : arm.transmission.cables) cable.coefficients = {1367.7, 37844.1};
  Model alone = arm;
  alone.rig.joints = {"1"};
  alone.joints = {arm.joints[1]};
  alone.transmission = antagonist_pair(2);
  for (Cable& cable : alone.transmission.cables) cable.coefficients = {1367.7, 37844.1};

  SimulationInput both = quiet_input(300, 1e-3, 2);
  SimulationInput second = quiet_input(300, 1e-3);
  for (Eigen::Index i = 0; i < 300; ++i) {
    both.tau(i, 0) = 15;
    both.tau(i, 1) = second.tau(i, 0) = 20 * std::sin(0.05 * static_cast<double>(i));
  }
  const SimulationResult arm_moves = simulate(arm, both, {});
  const SimulationResult joint_moves = simulate(alone, second, {});
  CHECK((arm_moves.q.col(1) == joint_moves.q.col(0)).all());
  CHECK((arm_moves.tension.rightCols(2) == joint_moves.tension).all());
  CHECK(arm_moves.q(299, 0) > 0.01);
}

TEST_CASE("a blocked link stays where it is", "[simulate]") {
  SimulationInput input = quiet_input(200, 1e-3);
  input.q0[0] = 0.1;
  input.theta0[0] = 0.1;
  input.tau.setConstant(40);
  SimulationOptions options;
  options.link_blocked = true;
  const SimulationResult result = simulate(paper_rig_low(), input, options);
  CHECK((result.q == 0.1).all());
  CHECK((result.qd == 0).all());
  CHECK(result.theta(199, 0) > 0.11);
}

TEST_CASE("a model that diverges says at which row", "[simulate]") {
  const Model model = rigid_drive({1e-3, -50, 0, 0});  // friction that drives
  SimulationInput input = quiet_input(100, 1e-3);
  input.thetad0[0] = 1;
  const SimulationResult result = simulate(model, input, {});
  REQUIRE(result.diverged_at);
  const Eigen::Index at = *result.diverged_at;
  CHECK(at > 0);
  CHECK(at < 100);
  CHECK(result.theta.topRows(at).isFinite().all());
  CHECK(result.theta.bottomRows(100 - at).isNaN().all());
  CHECK(result.tau.bottomRows(100 - at).isNaN().all());
  CHECK(simulate(rigid_drive({0, 1, 1, 0}), input, {}).diverged_at == 0);
  CHECK(simulate(rigid_drive({std::nan(""), 1, 1, 0}), input, {}).diverged_at == 0);
  CHECK_FALSE(simulate(rigid_drive({1, 1, 1, 0}), input, {}).diverged_at);
}

TEST_CASE("an input without rows gives a result without rows", "[simulate]") {
  const SimulationResult result = simulate(paper_rig_low(), quiet_input(0, 1e-3), {});
  CHECK(result.q.rows() == 0);
  CHECK(result.tension.cols() == 2);
}

TEST_CASE("the gap of two signals", "[simulate]") {
  Eigen::ArrayXd measured(4), simulated(4);
  measured << 1, 3, 1, 3;
  simulated << 1, 3, 2, 1;
  const Gap result = gap(measured, simulated);
  CHECK(result.rms == Approx(std::sqrt(5.0 / 4)).epsilon(1e-15));
  CHECK(result.max_abs == 2);
  CHECK(result.relative == Approx(std::sqrt(5.0 / 4)).epsilon(1e-15));
}

}  // namespace
