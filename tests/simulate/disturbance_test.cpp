// Disturbance torques of the simulator.
#include <catch2/catch.hpp>

#include "tests/simulate/benches.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

SimulationInput pushed(double tau, double load) {
  SimulationInput input = quiet_input(500, 1e-3);
  input.tau.setConstant(tau);
  input.tau_load = Eigen::ArrayXXd::Constant(500, 1, load);
  return input;
}

TEST_CASE("a disturbance on the motor is a torque that the log does not show") {
  SimulationInput disturbed = pushed(5, 1);
  disturbed.motor_disturbance = Eigen::ArrayXXd::Constant(500, 1, 2);
  const SimulationResult a = simulate(paper_rig_low(), disturbed, {});
  const SimulationResult b = simulate(paper_rig_low(), pushed(7, 1), {});
  CHECK((a.theta == b.theta).all());
  CHECK((a.tau == 5).all());
}

TEST_CASE("a disturbance on the link adds to its load") {
  SimulationInput disturbed = pushed(5, 1);
  disturbed.link_disturbance = Eigen::ArrayXXd::Constant(500, 1, 2);
  CHECK(
      (simulate(paper_rig_low(), disturbed, {}).q == simulate(paper_rig_low(), pushed(5, 3), {}).q)
          .all());
}

TEST_CASE("a load law of q does not hide a disturbance") {
  Model model = paper_rig_low();
  model.rig.load.law = &find_load_law("constant");
  model.rig.load.parameters.torque = 1;
  SimulationInput disturbed = pushed(5, 0);
  disturbed.link_disturbance = Eigen::ArrayXXd::Constant(500, 1, 2);
  const SimulationResult a = simulate(model, disturbed, {});
  const SimulationResult b = simulate(paper_rig_low(), pushed(5, 3), {});
  // Added in another order: rounding only, 1e-12 of some 0.1 rad.
  CHECK(((a.q - b.q).abs() < 1e-12).all());
}

}  // namespace
