// Stick, sliding, stops and reversals.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/simulate/benches.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

TEST_CASE("a link on a spring stays exactly still below its friction", "[simulate]") {
  // The motor is held by its own friction (30 N m), the spring pulls the link with 0.999 f_s.
  const Model model = spring_joint({0.3, 5, 3.0}, {0.02, 1, 30, 0}, 1800);
  SimulationInput input = quiet_input(1000, 1e-3);
  input.q0[0] = 0.4;
  input.theta0[0] = 0.4 + 0.999 * 3.0 / 1800;
  const SimulationResult result = simulate(model, input, {});
  CHECK((result.q == 0.4).all());
  CHECK((result.qd == 0).all());
  CHECK((result.theta == input.theta0[0]).all());
  input.theta0[0] = 0.4 + 1.001 * 3.0 / 1800;
  CHECK(simulate(model, input, {}).q(999, 0) > 0.4);
}

TEST_CASE("a sliding body slows down evenly and stops exactly", "[simulate]") {
  // v = v0 - f t / J, at rest after J v0 / f = 0.30003 s at v0^2 J / (2 f).
  const double inertia = 0.2, friction = 1.9998, v0 = 3;
  for (const double sign : {1.0, -1.0}) {
    const Model model = rigid_drive({inertia, 0, friction, 0});
    SimulationInput input = quiet_input(500, 1e-3);
    input.thetad0[0] = sign * v0;
    const SimulationResult result = simulate(model, input, {});
    for (Eigen::Index i = 0; i <= 300; ++i) {
      const double t = 1e-3 * static_cast<double>(i);
      CHECK(std::abs(result.thetad(i, 0) - sign * (v0 - friction / inertia * t)) < 1e-11);
    }
    for (Eigen::Index i = 301; i < 500; ++i) {
      CHECK(result.thetad(i, 0) == 0);
      CHECK(result.theta(i, 0) == result.theta(499, 0));
    }
    // The last step covers the triangle under the velocity with a trapezoid: off by h^2 f / (8 J).
    const double way = v0 * v0 * inertia / (2 * friction);
    CHECK(std::abs(result.theta(499, 0) - sign * way) < 25e-6 * 25e-6 * friction / inertia);
  }
}

TEST_CASE("a body pushed against its friction reverses at the right time", "[simulate]") {
  // Braked by tau + f, then driven back by tau - f: piecewise parabolas.
  const double inertia = 0.02, friction = 2, torque = -7, v0 = 1;
  const Model model = rigid_drive({inertia, 0, friction, 0});
  SimulationInput input = quiet_input(41, 1e-3);
  input.thetad0[0] = v0;
  input.tau.setConstant(torque);
  const SimulationResult result = simulate(model, input, {});
  const double braking = (torque - friction) / inertia, driving = (torque + friction) / inertia;
  const double stop = -v0 / braking;
  for (Eigen::Index i = 0; i < 41; ++i) {
    const double t = 1e-3 * static_cast<double>(i);
    const double v = t < stop ? v0 + braking * t : driving * (t - stop);
    const double x = t < stop ? (v0 + v) / 2 * t : v0 / 2 * stop + v / 2 * (t - stop);
    CHECK(std::abs(result.thetad(i, 0) - v) < 1e-11);  // the stop is inside a step, not at its end
    CHECK(std::abs(result.theta(i, 0) - x) < 25e-6 * 25e-6 * friction / inertia);
  }
}

TEST_CASE("an oscillator with dry friction loses 4 f / K per cycle and comes to rest",
          "[simulate]") {
  // The classical decrement: turning points at x0 - 2 n f / K, alternating sides.
  const double inertia = 0.3, stiffness = 800, friction = 2, q0 = 0.0412;
  const Model model = spring_joint({inertia, 0, friction}, {1e12, 0, 0, 0}, stiffness);
  SimulationInput input = quiet_input(2000, 1e-3);
  input.q0[0] = q0;
  const SimulationResult result = simulate(model, input, {});
  const double half_period = M_PI * std::sqrt(inertia / stiffness);
  const double loss = 2 * friction / stiffness;
  const int n_swings = static_cast<int>(std::ceil((q0 - friction / stiffness) / loss));
  REQUIRE(n_swings == 8);
  const double rest = q0 - loss * n_swings;  // even number of swings: on the side it started from
  const auto after = static_cast<Eigen::Index>(n_swings * half_period / 1e-3) + 2;
  CHECK(std::abs(result.q(1999, 0) - rest) < 1e-7);
  CHECK((result.qd.bottomRows(2000 - after) == 0).all());
  CHECK((result.q.bottomRows(2000 - after) == result.q(1999, 0)).all());
  CHECK(result.qd(after - 5, 0) != 0);
}

/// q after 0.3 s of a joint that reverses, sticks and slides, with a step of h.
double stick_slip_end(double h) {
  SimulationInput input = quiet_input(301, 1e-3);
  for (Eigen::Index i = 0; i < 301; ++i) {
    input.tau(i, 0) = 25 * std::sin(0.04 * static_cast<double>(i));
  }
  const SimulationResult result = simulate(paper_rig_low(), input, step_of(h));
  return result.q(300, 0);
}

TEST_CASE("stick-slip on the paper's rig converges with order 2 or nearly", "[simulate]") {
  const double reference = stick_slip_end(1e-3 / 4096);
  const double coarse = std::abs(stick_slip_end(1e-3 / 16) - reference);
  const double fine = std::abs(stick_slip_end(1e-3 / 256) - reference);
  // Stops fall at random places within a step, so single halvings scatter; over four of them the
  // error shrinks by 2^8 up to that scatter.
  CHECK(std::log2(coarse / fine) / 4 > 1.6);
  CHECK(std::abs(stick_slip_end(25e-6) - reference) < 1e-7);
}

}  // namespace
