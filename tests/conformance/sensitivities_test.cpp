// Forward sensitivities of every effect, cable law, routing and load are the derivatives of the
// simulation.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "cablefit/model/effects/effect_walk.hpp"
#include "cablefit/simulate/sensitivity/sensitive_plant.hpp"
#include "tests/conformance/transmissions.hpp"
#include "tests/simulate/benches.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

constexpr double kStep = 2e-4;
constexpr int kSteps = 100;

/// Forces that swing, so that axes turn round and cables go slack.
std::vector<double> forces_at(const SensitivePlant& plant, int step, double amplitude) {
  std::vector<double> forces;
  for (std::size_t a = 0; a < plant.n_axes(); ++a)
    forces.push_back(amplitude * std::sin(0.09 * step + 1.3 * static_cast<double>(a)));
  return forces;
}

/// Where a run starts, and what is added to every force.
struct Start {
  std::vector<double> position, velocity, extra;
};

SensitiveState run(SensitivePlant& plant, const Start& start, double amplitude) {
  plant.restart();
  plant.start(start.position.data(), start.velocity.data());
  for (int step = 0; step < kSteps; ++step) {
    std::vector<double> forces = forces_at(plant, step, amplitude);
    for (std::size_t a = 0; a < forces.size(); ++a) forces[a] += start.extra[a];
    plant.step(forces.data(), kStep);
  }
  SensitiveState state;
  plant.read(state);
  return state;
}

/// Positions and velocities after a run with one quantity moved.
std::vector<double> states(SensitivePlant& plant, const Start& start,
                           const std::vector<double>& parameters, double amplitude) {
  REQUIRE(plant.set_parameters(parameters.data()));
  const SensitiveState state = run(plant, start, amplitude);
  std::vector<double> all = state.position;
  all.insert(all.end(), state.velocity.begin(), state.velocity.end());
  return all;
}

/// Central differences of a smooth run with steps of 1e-6 of the size of a quantity. The plant's
/// own are one-sided: off by half of what curvature makes of 1e-6, of 1e-7 rad. Laws whose slope
/// changes by all of it within 1 mrad leave 1e-4 of the largest derivative.
constexpr double kShare = 1e-4;

/// `torque`: what the torques of the model are counted in, N m.
void check_all(const Model& model, double amplitude, double torque = 1) {
  const std::vector<ModelParameter> moving = model_parameters(model);
  SensitivePlant plant(model, moving, true);
  const std::size_t n = plant.n_axes(), columns = plant.n_columns();
  Start start{{}, {}, std::vector<double>(n, 0.0)};
  for (std::size_t a = 0; a < n; ++a) {
    start.position.push_back(0.01 * static_cast<double>(a + 1));
    start.velocity.push_back(0.3 - 0.2 * static_cast<double>(a));
  }
  std::vector<double> parameters;
  for (const ModelParameter& p : moving) parameters.push_back(parameter_value(model, p));
  REQUIRE(plant.set_parameters(parameters.data()));
  const SensitiveState state = run(plant, start, amplitude);
  bool any = false;
  for (std::size_t c = 0; c < columns; ++c) {
    Start moved = start;
    std::vector<double> values = parameters;
    double* quantity = c < moving.size()           ? &values[c]
                       : c < moving.size() + n     ? &moved.position[c - moving.size()]
                       : c < moving.size() + 2 * n ? &moved.velocity[c - moving.size() - n]
                                                   : &moved.extra[c - moving.size() - 2 * n];
    INFO((c < moving.size() ? moving[c].name : "input " + std::to_string(c - moving.size())));
    const bool is_torque = c < moving.size() || c >= moving.size() + 2 * n;
    const double step = 1e-6 * std::max(std::abs(*quantity), is_torque ? 0.1 * torque : 0.1);
    *quantity += step;
    const std::vector<double> above = states(plant, moved, values, amplitude);
    const bool is_on_bound = c < moving.size() && *quantity == step;  // friction is not negative
    const double back = is_on_bound ? step : 2 * step;
    *quantity -= back;
    const std::vector<double> below = states(plant, moved, values, amplitude);
    double largest = 0, error = 0;
    for (std::size_t a = 0; a < 2 * n; ++a) {
      const double exact =
          a < n ? state.by_position[a * columns + c] : state.by_velocity[(a - n) * columns + c];
      const double central = (above[a] - below[a]) / back;
      // Positions in units of what a velocity makes of them over the run.
      const double weight = a < n ? 1 / (kSteps * kStep) : 1;
      largest = std::max(largest, weight * std::abs(exact));
      error = std::max(error, weight * std::abs(exact - central));
    }
    // Rounding of a hundred steps of states of 1 (1e-16 each), over the step, and no less.
    CHECK(error <= kShare * largest + 1e-14 / step);
    any = any || largest > 0;
  }
  CHECK(any);
}

TEST_CASE("sensitivities of every base effect are derivatives", "[conformance]") {
  check_all(rigid_drive({0.2, 0.4, 0.3, 0.1}), 3);
  check_all(spring_joint({0.3, 0.5, 0.4}, {0.02, 0.3, 0.2, 0.1}, 900), 3);
  check_all(rigid_drive({0.2, 0.4, 0, 0.1}), 3);
}

TEST_CASE("sensitivities of a drive of micronewtons are derivatives", "[conformance]") {
  const double micro = 1e-5;
  check_all(rigid_drive({0.2 * micro, 0.4 * micro, 0.3 * micro, 0.1 * micro}), 3 * micro, micro);
  check_all(spring_joint({0.3 * micro, 0.5 * micro, 0.4 * micro},
                         {0.02 * micro, 0.3 * micro, 0, 0.1 * micro}, 900 * micro),
            3 * micro, micro);
}

TEST_CASE("sensitivities of every cable law and routing are derivatives", "[conformance]") {
  for_every_transmission([](const Transmission& transmission) {
    Model model = spring_joint({0.3, 0.5, 0.4}, {0.02, 0.3, 0.2, 0.1}, 0);
    model.joints.resize(static_cast<std::size_t>(transmission.n_joints), model.joints.front());
    model.transmission = transmission;
    model.rig.joints.resize(model.joints.size());
    check_all(model, 3);
  });
}

/// With values in the middle of the grids, and half of the dry friction of the rig.
EffectInstance middle(const Effect& row) {
  EffectInstance instance;
  instance.effect = &row;
  for (std::size_t k = 0; k < row.parameters.size(); ++k) {
    Estimate& e = instance.parameters.emplace_back();
    e.name = row.parameters[k].name;
    const std::size_t n = row.n_linear();
    e.value = k < n
                  ? 0.1
                  : row.shape[k - n].value(
                        row.shape[k - n].n_values / 2,
                        {.peak = 1, .usual = 0.5, .travel = 0.4, .speed = 2.5, .deflection = 0.03});
  }
  return instance;
}

TEST_CASE("sensitivities of every effect that refine may name are derivatives", "[conformance]") {
  for (const Effect& row : candidate_effects()) {
    if (!acts_as_torque(row) || row.is_event) continue;
    INFO(row.name << " of the " << to_string(row.site));
    Model model = spring_joint({0.3, 0.5, 0.4}, {0.02, 0.3, 0.2, 0.1}, 900);
    model.joints.front().added = {middle(row)};
    check_all(model, 3);
  }
}

TEST_CASE("sensitivities follow load laws of the position", "[conformance]") {
  for (const LoadLaw& law : load_laws()) {
    INFO(law.name);
    Model model = paper_rig_low();
    model.rig.load.law = &law;
    model.rig.load.parameters = {.torque = 2,
                                 .mass = 1,
                                 .radius = 0.1,
                                 .length = 0.3,
                                 .zero = 0.2,
                                 .q = {-0.5, 0.003, 0.4},
                                 .table_torque = {1, -2, 3}};
    check_all(model, 8);
  }
}

/// 1 s of the paper's rig with stops, reversals, and both cables taut and slack.
TEST_CASE("the plant with sensitivities moves as the simulator does", "[conformance]") {
  const Model model = paper_rig_low();
  SimulationInput input = quiet_input(1001, 1e-3);
  for (Eigen::Index i = 0; i < 1001; ++i)
    input.tau(i, 0) = i % 250 < 180 ? 12 * std::sin(0.02 * static_cast<double>(i)) : 0.0;
  const SimulationResult simulated = simulate(model, input, step_of(1e-4));
  SensitivePlant plant(model, model_parameters(model), true);
  SensitiveState state;
  Eigen::Index still = 0;
  const double zero[2] = {0, 0};
  plant.start(zero, zero);
  for (Eigen::Index i = 0; i < 1001; ++i) {
    plant.read(state);
    // Both round every step to 1e-16 of a state of 1, and friction forgets it.
    CHECK(std::abs(state.position[0] - simulated.q(i, 0)) <= 1e-12);
    CHECK(std::abs(state.position[1] - simulated.theta(i, 0)) <= 1e-12);
    CHECK(std::abs(state.velocity[1] - simulated.thetad(i, 0)) <= 1e-9);
    if (state.velocity[1] == 0) ++still;
    const double forces[] = {0, input.tau(i, 0)};
    for (int s = 0; s < 10; ++s) plant.step(forces, 1e-4);
  }
  CHECK(still > 50);
  CHECK(still < 900);
}

TEST_CASE("an axis that dry friction holds forgets its velocity", "[conformance]") {
  const Model model = rigid_drive({0.2, 0.4, 1.0, 0.1});
  SensitivePlant plant(model, model_parameters(model), true);
  const double position = 0, velocity = 0.01, push = 0.5;
  plant.start(&position, &velocity);
  for (int s = 0; s < 100; ++s) plant.step(&push, 1e-4);
  SensitiveState state;
  plant.read(state);
  CHECK(state.velocity[0] == 0);
  for (const double by : state.by_velocity) CHECK(by == 0);
  // How far it came still depends on how it came.
  CHECK(state.by_position[plant.first_input() + 1] > 0);
}

}  // namespace
