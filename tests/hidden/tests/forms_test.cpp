// Functional forms against their equations, worked out here once more at one state.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "effects/effects.hpp"

using namespace hidden;

namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;

/// Both sides move, at different speeds and places.
State state() {
  State s;
  s.t = 10;
  s.h = 1e-4;
  s.q = 0.3;
  s.qd = -0.2;
  s.theta = 0.31;
  s.thetad = 0.1;
  s.phi = 0.01;
  s.phid = 0.3;
  s.tau_elas = 16;
  s.tension = 20;
  return s;
}

/// What an effect of size 1 with u = 0.5, w = 0.25 does at that state: torque on its side (friction
/// as its share in the direction of motion), transmission torque or deflection.
double acts(const char* id) {
  Draw draw;
  draw.size = 1;
  draw.w = 0.25;
  Run run;
  run.number = draw.event_run;
  const Hooks hooks = row_of(id).make(draw, run, Bench{}).hooks;
  const State s = state();
  if (hooks.transmission) return hooks.transmission(s);
  if (hooks.deflection) return hooks.deflection(s);
  Sides sides;
  hooks.sides(s, sides);
  return sides.link.torque - sides.link.down + sides.motor.torque + sides.motor.up;
}

double square(double x) { return x * x; }

}  // namespace

TEST_CASE("an effect acts as its equation says") {
  struct Expected {
    const char* id;
    double value;
  };
  // u = 0.5: v_s = 0.12, v_0 = 0.5, exponent 0.5, order 20 (friction) and 22 (cogging), phase pi
  // or, from w, pi/2; signs drawn by u are negative from 0.5 on.
  const double link = 0.2, motor = 0.1, v_s = 0.12;
  for (const Expected& one : {
           Expected{"constant_torque.link", -1},
           Expected{"asymmetric_viscous.link", -link},
           Expected{"asymmetric_viscous.motor", -motor},
           Expected{"asymmetric_viscous.link.bent", -std::pow(link, 1.4)},
           Expected{"gravity_imbalance.link", -std::sin(0.3)},
           Expected{"gravity_imbalance.link.cable_loop", -std::sin(0.3) - 0.35 * std::sin(0.6)},
           Expected{"stribeck.link", -std::exp(-square(link / v_s))},
           Expected{"stribeck.motor", std::exp(-square(motor / v_s))},
           Expected{"stribeck.link.exponential", -std::exp(-link / v_s)},
           Expected{"stribeck.motor.lorentzian", 1 / (1 + square(motor / v_s))},
           Expected{"asymmetric_viscous.motor.bent", -std::pow(motor, 1.4)},
           Expected{"quadratic_drag.link", -square(link)},
           Expected{"quadratic_drag.motor", square(motor)},
           Expected{"quadratic_drag.motor.power_1_6", std::pow(motor, 1.6)},
           Expected{"nonlinear_viscous.link", -std::sqrt(link)},
           Expected{"nonlinear_viscous.motor", std::sqrt(motor)},
           Expected{"nonlinear_viscous.link.hyperbolic", -2 * link / (link + 0.5)},
           Expected{"nonlinear_viscous.motor.hyperbolic", 2 * motor / (motor + 0.5)},
           Expected{"position_friction.link", -std::cos(6)},
           Expected{"position_friction.motor", std::cos(6.2)},
           Expected{"position_friction.link.triangle",
                    -std::asin(std::cos(6)) * 2 / std::numbers::pi},
           Expected{"position_friction.motor.triangle",
                    std::asin(std::cos(6.2)) * 2 / std::numbers::pi},
           Expected{"tension_friction.link", -20},
           Expected{"tension_friction.motor", 20},
           Expected{"tension_friction.motor.power_1_25", 30 * std::pow(2.0 / 3, 1.25)},
           Expected{"tension_friction.link.power_1_25", -30 * std::pow(2.0 / 3, 1.25)},
           Expected{"cogging.motor", std::cos(22 * 0.31)},
           Expected{"cogging.motor.two_harmonics",
                    std::cos(22 * 0.31) + 0.5 * std::sin(44 * 0.31 + kTwoPi / 2 + 1)},
           Expected{"drive_efficiency.motor", 16},
           Expected{"offset_drift.sensor", 1 - std::exp(-10.0 / 8)},
           Expected{"offset_drift.sensor.line", 0.5},
           Expected{"cable_damping.transmission", 0.3},
           Expected{"cable_damping.transmission.power_0_7", std::pow(0.3, 0.7)},
           Expected{"cable_hysteresis.transmission", 1 - std::exp(-0.3 * 0.5e-4 / 8e-4)},
           Expected{"pulley_eccentricity.transmission", -std::sin(0.3)},
           Expected{"dead_zone.transmission.round", std::exp(-0.01) - 1},
           Expected{"slip.transmission", -1},
           Expected{"slip.transmission.gradual", 0},  // t0 is now
           Expected{"contact.link.knock", -1},
           Expected{"payload_change.link", std::cos(0.3)},
           Expected{"hum.motor", std::sin(kTwoPi * 73 + kTwoPi / 2)},
           Expected{"flutter.transmission", 16 * std::sin(kTwoPi * 17 + kTwoPi / 2)},
           Expected{"warming_stiffness.transmission", -16 * (1 - std::exp(-10.0 / 8))},
           Expected{"speed_times_cube.link", 0.2 * 0.027},
           Expected{"wall.link", 0.05},
           Expected{"neighbour.link", std::pow(std::sin(-kTwoPi * 10 / 1.3), 3)},
           Expected{"acceleration_friction.link", 0},  // at rest so far, as are the next two
           Expected{"rest_friction.link", 0},
           Expected{"base_flexibility.transmission", 0},
       }) {
    INFO(one.id);
    CHECK(std::abs(acts(one.id) - one.value) < 1e-9);
  }
}
