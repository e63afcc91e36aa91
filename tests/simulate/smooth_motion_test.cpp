// Motion without dry friction, against closed forms.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/simulate/benches.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

/// Largest error of q over 1 s of a damped oscillator, link on a blocked motor: the motor is so
/// heavy that it stays (J_motor 1e12), the link swings as q'' + f_v/J q' + K/J q = 0 from q0 = 0.1.
double oscillator_error(double step) {
  const double inertia = 0.3, damping = 1.2, stiffness = 800;
  const Model model = spring_joint({inertia, damping, 0}, {1e12, 0, 0, 0}, stiffness);
  SimulationInput input = quiet_input(101, 0.01);
  input.q0[0] = 0.1;
  const SimulationResult result = simulate(model, input, step_of(step));
  const double decay = damping / (2 * inertia);
  const double omega = std::sqrt(stiffness / inertia - decay * decay);
  double largest = 0;
  for (Eigen::Index i = 0; i < 101; ++i) {
    const double t = 0.01 * static_cast<double>(i);
    const double exact =
        0.1 * std::exp(-decay * t) * (std::cos(omega * t) + decay / omega * std::sin(omega * t));
    largest = std::max(largest, std::abs(result.q(i, 0) - exact));
  }
  return largest;
}

TEST_CASE("a damped oscillator converges to its closed form with order 2", "[simulate]") {
  const std::vector<double> errors{oscillator_error(4e-4), oscillator_error(2e-4),
                                   oscillator_error(1e-4)};
  // The next term of the error is h^2 smaller by (omega h)^2 / 10 ~ 1e-5.
  CHECK(std::abs(convergence_order(errors) - 2) < 0.02);
  // Phase error of Verlet: omega^3 h^2 t / 24 rad after t = 1 s, omega = 51.6 rad/s, h = 25 us:
  // 3.6e-6 rad of phase, at most 0.1 rad of it, and half as much again from the damping.
  CHECK(oscillator_error(25e-6) < 0.1 * 3.6e-6 * 1.5);
}

TEST_CASE("a spring between two free bodies keeps momentum and beats at its frequency",
          "[simulate]") {
  const Model model = spring_joint({0.3, 0, 0}, {0.02, 0, 0, 0}, 1800);
  SimulationInput input = quiet_input(2001, 1e-3);
  input.theta0[0] = 0.01;
  const SimulationResult result = simulate(model, input, step_of(25e-6));
  const double omega = std::sqrt(1800 / 0.3 + 1800 / 0.02);
  for (Eigen::Index i = 0; i < 2001; ++i) {
    const double t = 1e-3 * static_cast<double>(i);
    CHECK(std::abs(0.3 * result.qd(i, 0) + 0.02 * result.thetad(i, 0)) < 1e-12);
    // Phase error omega^3 h^2 t / 24 = 1.5e-3 rad at t = 2 s, of an amplitude of 0.01.
    const double phi = result.theta(i, 0) - result.q(i, 0);
    CHECK(std::abs(phi - 0.01 * std::cos(omega * t)) < 2e-5);
  }
}

TEST_CASE("strong viscous friction is stable at any step", "[simulate]") {
  // Time constant J/f_v = 1 us, a 25th of the step; it comes to rest without overshoot.
  const Model model = rigid_drive({1e-5, 10, 0, 0});
  SimulationInput input = quiet_input(50, 1e-3);
  input.thetad0[0] = 3;
  const SimulationResult result = simulate(model, input, {});
  CHECK(result.thetad(0, 0) == 3);
  for (Eigen::Index i = 1; i < 50; ++i) CHECK(result.thetad(i, 0) == 0);
}

TEST_CASE("a rigid drive with a load law of q is a pendulum", "[simulate]") {
  // Small swings about zero: omega^2 = m g L / J.
  Model model = rigid_drive({0.2, 0, 0, 0});
  model.rig.load.law = &find_load_law("pendulum");
  model.rig.load.parameters.mass = 1;
  model.rig.load.parameters.length = 0.3;
  model.rig.load.parameters.zero = 0.5;
  SimulationInput input = quiet_input(1001, 1e-3);
  input.theta0[0] = 0.5 + 1e-4;
  const SimulationResult result = simulate(model, input, {});
  const double omega = std::sqrt(kGravity * 0.3 / 0.2);
  for (Eigen::Index i = 0; i < 1001; ++i) {
    const double expected = 0.5 + 1e-4 * std::cos(omega * 1e-3 * static_cast<double>(i));
    // sin x = x - x^3/6: 1e-9 relative; Verlet: (omega h)^2 / 24 * omega t ~ 1e-8.
    CHECK(std::abs(result.theta(i, 0) - expected) < 1e-11);
    CHECK(result.q(i, 0) == result.theta(i, 0));
  }
}

TEST_CASE("the torque is held over a row, or linear between rows", "[simulate]") {
  const Model model = rigid_drive({2, 0, 0, 0});
  SimulationInput input = quiet_input(3, 0.1);
  input.tau.col(0) << 4, 8, 0;
  const SimulationResult held = simulate(model, input, {});
  CHECK(held.thetad(1, 0) == Approx(0.2).epsilon(1e-12));
  CHECK(held.thetad(2, 0) == Approx(0.6).epsilon(1e-12));
  SimulationOptions linear;
  linear.hold_torque = false;
  const SimulationResult ramp = simulate(model, input, linear);
  CHECK(ramp.thetad(1, 0) == Approx(0.3).epsilon(1e-12));
  CHECK(ramp.thetad(2, 0) == Approx(0.5).epsilon(1e-12));
  CHECK(ramp.tau(1, 0) == 8);
}

TEST_CASE("a load column acts on the link and is linear between rows", "[simulate]") {
  const Model model = spring_joint({2, 0, 0}, {1, 0, 0, 0}, 0);  // nothing between the bodies
  SimulationInput input = quiet_input(3, 0.1);
  input.tau_load = Eigen::ArrayXXd(3, 1);
  input.tau_load.col(0) << 4, 8, 0;
  const SimulationResult result = simulate(model, input, {});
  CHECK(result.qd(2, 0) == Approx(0.5).epsilon(1e-12));
  CHECK(result.theta(2, 0) == 0);
  Model with_law = model;
  with_law.rig.load.law = &find_load_law("none");
  CHECK(simulate(with_law, input, {}).qd(2, 0) == 0);
}

}  // namespace
