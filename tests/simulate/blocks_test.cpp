// A simulation block by block gives the bits of one go.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/simulate/benches.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

constexpr Eigen::Index kRows = 500;

SimulationInput swinging_input() {
  SimulationInput input = quiet_input(kRows, 1e-3);
  input.tau_load = input.theta_ref = input.tau;
  for (Eigen::Index i = 0; i < kRows; ++i) {
    const double t = 1e-3 * static_cast<double>(i);
    input.tau(i, 0) = 40 * std::sin(60 * t);
    input.tau_load(i, 0) = 5 * std::sin(20 * t);
    input.theta_ref(i, 0) = 0.1 * (1 - std::cos(15 * t));
  }
  return input;
}

SimulationInput rows_of(const SimulationInput& input, Eigen::Index begin, Eigen::Index n_rows) {
  SimulationInput block;
  block.period = input.period;
  block.tau = input.tau.middleRows(begin, n_rows);
  block.tau_load = input.tau_load.middleRows(begin, n_rows);
  block.theta_ref = input.theta_ref.middleRows(begin, n_rows);
  return block;
}

Eigen::ArrayXXd in_blocks(const Model& model, const SimulationInput& input,
                          const SimulationOptions& options, Eigen::Index block_rows) {
  Simulation simulation(model, input, options);
  Eigen::ArrayXXd table(kRows, 3);
  for (Eigen::Index begin = 0; begin < kRows; begin += block_rows) {
    const Eigen::Index n_rows = std::min(block_rows, kRows - begin);
    const Eigen::Index with_next = std::min(n_rows + 1, kRows - begin);
    const SimulationResult result = simulation.run(rows_of(input, begin, with_next), n_rows);
    table.middleRows(begin, n_rows) << result.q, result.theta, result.tau;
  }
  return table;
}

void check_same(const Model& model, const SimulationOptions& options) {
  const SimulationInput input = swinging_input();
  const SimulationResult whole = simulate(model, input, options);
  Eigen::ArrayXXd expected(kRows, 3);
  expected << whole.q, whole.theta, whole.tau;
  REQUIRE(expected.isFinite().all());
  for (const Eigen::Index block_rows : {1, 7, 100, 499, 500}) {
    INFO(block_rows << " rows at a time");
    CHECK((in_blocks(model, input, options, block_rows) == expected).all());
  }
}

TEST_CASE("torque replay, held and linear between rows", "[simulate]") {
  SimulationOptions options;
  check_same(paper_rig_low(), options);
  options.hold_torque = false;
  check_same(paper_rig_low(), options);
}

TEST_CASE("closed loop, the controller slower and faster than the log", "[simulate]") {
  Model model = paper_rig_low();
  model.rig.controller = Controller{};
  model.rig.controller->kp = 800;
  model.rig.controller->kd = 6;
  model.rig.sensors["theta"].quantum = 2.4e-5;
  SimulationOptions options;
  options.closed_loop = true;
  for (const double period : {0.0, 0.5e-3, 3e-3}) {
    INFO("controller's period " << period);
    model.rig.controller->period = period;
    check_same(model, options);
  }
}

}  // namespace
