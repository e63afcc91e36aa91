#include <catch2/catch.hpp>
#include <cmath>

#include "tests/simulate/benches.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

/// Energy of f = c0 l + c1 l^2.
double cable_energy(const Cable& cable, double l) {
  if (l <= 0) return 0;
  return cable.coefficients[0] * l * l / 2 + cable.coefficients[1] * l * l * l / 3;
}

double energy(const Model& model, const SimulationResult& r, Eigen::Index row) {
  const double phi = r.theta(row, 0) - r.q(row, 0);
  const std::vector<Cable>& cables = model.transmission.cables;
  return 0.5 * 0.339 * r.qd(row, 0) * r.qd(row, 0) +
         0.5 * 0.0133 * r.thetad(row, 0) * r.thetad(row, 0) +
         cable_energy(cables[0], phi + cables[0].initial_elongation) +
         cable_energy(cables[1], -phi + cables[1].initial_elongation);
}

TEST_CASE("energy never grows without input", "[simulate]") {
  const double preload = GENERATE(0.0, 0.005, -0.003);  // l_o: none, taut, dead travel
  Model model = paper_rig_low();
  model.joints[0].motor[3].parameters[0].value = 0;  // the offset is an input
  for (Cable& cable : model.transmission.cables) cable.initial_elongation = preload;
  SimulationInput input = quiet_input(1000, 1e-3);
  input.theta0[0] = 0.03;
  input.qd0[0] = -1.5;
  const SimulationResult result = simulate(model, input, {});
  const double start = energy(model, result, 0);
  // Verlet's energy ripples by (omega h)^2 / 8; K <= 1575 + 2 * 37844 * 0.05 N m/rad on 0.0133 kg
  // m^2 is omega = 630 rad/s, so 3e-5 of what is left.
  double before = start;
  for (Eigen::Index i = 1; i < 1000; ++i) {
    const double now = energy(model, result, i);
    CHECK(now <= before * (1 + 6e-5));
    before = now;
  }
  CHECK(before < 0.1 * start);
  CHECK(result.qd(999, 0) == 0);
  CHECK(result.thetad(999, 0) == 0);
}

TEST_CASE("energy is kept without friction", "[simulate]") {
  Model model = paper_rig_low();
  model.joints[0].link = base_effects_with(Side::link, {0.339, 0, 0});
  model.joints[0].motor = base_effects_with(Side::motor, {0.0133, 0, 0, 0});
  SimulationInput input = quiet_input(5000, 1e-3);
  input.theta0[0] = 0.03;
  const SimulationResult result = simulate(model, input, {});
  const double start = energy(model, result, 0);
  for (Eigen::Index i = 0; i < 5000; ++i) {
    CHECK(std::abs(energy(model, result, i) - start) < 6e-5 * start);  // as above, no drift
  }
}

TEST_CASE("a slack cable has no tension and the slack side no torque", "[simulate]") {
  Model model = paper_rig_low();
  for (Cable& cable : model.transmission.cables) cable.initial_elongation = -0.01;
  model.joints[0].link = base_effects_with(Side::link, {0.339, 0, 0});
  SimulationInput input = quiet_input(50, 1e-3);
  input.qd0[0] = 0.1;
  input.theta0[0] = 0.009;  // both cables slack until q reaches 0.019
  const SimulationResult result = simulate(model, input, {});
  CHECK((result.tension == 0).all());
  CHECK((result.theta == 0.009).all());
  CHECK(std::abs(result.q(49, 0) - 0.0049) < 1e-14);
  input.theta0[0] = 0.03;
  const SimulationResult taut = simulate(model, input, {});
  CHECK(taut.tension(0, 0) == Approx(1367.7 * 0.02 + 37844.1 * 0.0004).epsilon(1e-12));
  CHECK(taut.tension(0, 1) == 0);
}

}  // namespace
