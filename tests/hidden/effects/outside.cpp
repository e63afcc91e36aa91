// Nothing of the catalogue: the right answer is "unexplained".
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "../random.hpp"
#include "effects.hpp"

namespace hidden {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;

template <bool kMotor, typename Torque>
Hooks torque(Torque value) {
  Hooks hooks;
  hooks.sides = [value](const State& s, Sides& sides) {
    (kMotor ? sides.motor : sides.link).torque += value(s);
  };
  return hooks;
}

/// A mass that a light spring holds to the link: 9 Hz by itself, damping ratio 0.03.
Planted attached_mode(const Draw& draw, const Run&, const Bench&) {
  const double J = draw.size, omega = kTwoPi * 9, k = J * omega * omega, c = 2 * 0.03 * J * omega;
  struct Mass {
    double x = 0, v = 0;
    bool placed = false;
  };
  const auto mass = std::make_shared<Mass>();
  const auto pull = [=](const State& s) {
    return mass->placed ? k * (s.q - mass->x) + c * (s.qd - mass->v) : 0;
  };
  Hooks hooks = torque<false>(pull);
  hooks.advance = [=](const State& s) {
    if (!mass->placed) *mass = {s.q, s.qd, true};
    mass->v += s.h * pull(s) / J;
    mass->x += s.h * mass->v;
  };
  return {hooks, {{"inertia", J, "kg m^2"}, {"frequency", 9, "Hz"}}};
}

Planted hum(const Draw& draw, const Run&, const Bench&) {
  const double a = draw.size, phase = kTwoPi * draw.u;
  return {torque<true>([=](const State& s) { return a * std::sin(kTwoPi * 7.3 * s.t + phase); }),
          {{"amplitude", a, "N m"}, {"frequency", 7.3, "Hz"}}};
}

/// From 3 to 15 Hz in 20 s, again and again.
Planted chirp(const Draw& draw, const Run&, const Bench&) {
  const double a = draw.size;
  return {torque<false>([a](const State& s) {
            const double t = std::fmod(s.t + 20, 20);
            return a * std::sin(kTwoPi * (3 + 0.3 * t) * t);
          }),
          {{"amplitude", a, "N m"}}};
}

/// Stiffness that breathes with time, not with load or position.
Planted flutter(const Draw& draw, const Run&, const Bench&) {
  const double a = draw.size, phase = kTwoPi * draw.u;
  Hooks hooks;
  hooks.transmission = [=](const State& s) {
    return a * std::sin(kTwoPi * 1.7 * s.t + phase) * s.tau_elas;
  };
  return {hooks, {{"fraction", a, ""}, {"frequency", 1.7, "Hz"}}};
}

/// Ornstein-Uhlenbeck torque with a correlation time of 0.3 s, straight between whole ms.
Planted wander(const Draw& draw, const Run& run, const Bench&) {
  const double keep = std::exp(-1 / (0.3 * kRate)), fresh = std::sqrt(1 - keep * keep);
  Random random(draw.seed, "wander " + run.name);
  const auto path = std::make_shared<std::vector<double>>();
  double x = random.normal();
  for (std::size_t k = 0; k < run.reference.size() + 1002; ++k) {
    path->push_back(draw.size * x);
    x = keep * x + fresh * random.normal();
  }
  return {torque<false>([path](const State& s) { return value_at(*path, s.t); }),
          {{"sd", draw.size, "N m"}}};
}

using enum Form;

constexpr std::array kRows{
    Row{"attached_mode", "link", "", outside, "", 0.02, "kg m^2", Shows::link,
        "a mass on a spring, 9 Hz", attached_mode},
    Row{"hum", "motor", "", outside, "", 0.4, "N m", Shows::motor, "+ a sin(2 pi 7.3 t + p)", hum},
    Row{"wander", "link", "", outside, "", 0.3, "N m", Shows::link,
        "Ornstein-Uhlenbeck torque, 0.3 s", wander},
    Row{"chirp", "link", "", outside, "", 0.5, "N m", Shows::link, "3 to 15 Hz in 20 s", chirp},
    Row{"flutter", "transmission", "", outside, "", 0.03, "", Shows::opposite,
        "tau_elas (1 + a sin(2 pi 1.7 t + p))", flutter},
};

}  // namespace

std::span<const Row> outside_rows() { return kRows; }

}  // namespace hidden
