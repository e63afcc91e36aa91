// Against a simulator that shares no code with this one, tests/truth: same torque, same motion.
#include <catch2/catch.hpp>

#include "tests/simulate/benches.hpp"
#include "tests/truth/rig.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

TEST_CASE("the paper's low rig moves as the independent simulator says", "[simulate]") {
  truth::MovingOptions options;
  options.duration = 1.0;
  options.load = 30;
  options.quantum_theta = 0;
  options.fine_rate = 4e6;  // its steps are of first order at stops: 100 times finer than ours
  const truth::Rig rig = truth::Rig::low();
  truth::Truth truth;
  truth::simulate_moving(rig, options, &truth);

  const auto n_rows = static_cast<Eigen::Index>(truth.q.size());
  SimulationInput input = quiet_input(n_rows, 1e-3);
  input.theta0[0] = rig.deflection_for(-30);
  input.tau_load = Eigen::ArrayXXd::Constant(n_rows, 1, 30);
  input.tau = Eigen::Map<const Eigen::ArrayXd>(truth.tau.data(), n_rows);
  const SimulationResult result = simulate(paper_rig_low(), input, {});

  const Eigen::Map<const Eigen::ArrayXd> q(truth.q.data(), n_rows);
  const Eigen::Map<const Eigen::ArrayXd> theta(truth.theta.data(), n_rows);
  CHECK(q.abs().maxCoeff() > 0.01);
  CHECK((result.q.col(0) - q).abs().maxCoeff() < 1e-6);
  CHECK((result.theta.col(0) - theta).abs().maxCoeff() < 1e-6);
}

TEST_CASE("and so in closed loop, and with the link blocked", "[simulate]") {
  truth::BlockedOptions options;
  options.duration = 1.0;
  options.fine_rate = 4e6;
  const truth::Rig rig = truth::Rig::low();
  truth::Truth truth;
  truth::simulate_blocked(rig, options, &truth);

  Model model = paper_rig_low();
  model.rig.controller = Controller{};
  model.rig.controller->kp = options.kp;
  model.rig.controller->kd = options.kd;
  model.rig.controller->limit = options.limit;
  model.rig.sensors["theta"].quantum = options.quantum_theta;
  const auto n_rows = static_cast<Eigen::Index>(truth.q.size());
  SimulationInput input = quiet_input(n_rows, 1 / options.rate);
  input.theta_ref = Eigen::Map<const Eigen::ArrayXd>(truth.theta_ref.data(), n_rows);
  SimulationOptions settings;
  settings.closed_loop = settings.link_blocked = true;
  const SimulationResult result = simulate(model, input, settings);
  const Eigen::Map<const Eigen::ArrayXd> theta(truth.theta.data(), n_rows);
  // The encoder's steps feed back through kp and kd, so a last bit may turn a count.
  CHECK((result.theta.col(0) - theta).abs().maxCoeff() < 2 * options.quantum_theta);
}

}  // namespace
