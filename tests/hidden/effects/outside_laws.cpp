// Laws of friction, stiffness and structure that the catalogue does not have: the right answer is
// "unexplained".
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "../random.hpp"
#include "effects.hpp"

namespace hidden {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;

template <typename Torque>
Hooks link_torque(Torque value) {
  Hooks hooks;
  hooks.sides = [value](const State& s, Sides& sides) { sides.link.torque += value(s); };
  return hooks;
}

template <typename More>
Hooks link_coulomb(More more) {
  Hooks hooks;
  hooks.sides = [more](const State& s, Sides& sides) {
    const double extra = more(s);
    sides.link.up += extra;
    sides.link.down += extra;
  };
  return hooks;
}

/// Coulomb friction that is larger while the link speeds up: the acceleration is that of the last
/// 2 ms.
Planted acceleration_friction(const Draw& draw, const Run&, const Bench&) {
  constexpr double kMemory = 2e-3, kSoft = 1;  // s, rad/s^2
  struct Past {
    double v = 0, acceleration = 0;
  };
  const auto past = std::make_shared<Past>();
  const double a = draw.size;
  Hooks hooks = link_coulomb(
      [=](const State& s) { return a * std::tanh(past->acceleration * sign(s.qd) / kSoft); });
  hooks.advance = [=](const State& s) {
    const double share = s.h / kMemory;
    past->acceleration += share * ((s.qd - past->v) / s.h - past->acceleration);
    past->v = s.qd;
  };
  return {hooks, {{"amplitude", a, "N m"}}};
}

/// Contacts grow while they rest and are renewed by sliding (Dieterich 1979).
Planted rest_friction(const Draw& draw, const Run&, const Bench&) {
  constexpr double kDistance = 5e-3, kScale = 0.1;  // rad, s
  const auto age = std::make_shared<double>(0);
  const double a = draw.size;
  Hooks hooks = link_coulomb([=](const State&) { return a * std::log1p(*age / kScale); });
  hooks.advance = [=](const State& s) {
    const double rate = std::abs(s.qd) / kDistance;
    *age = (*age + s.h) / (1 + s.h * rate);
  };
  return {hooks, {{"amplitude", a, "N m"}}};
}

Planted warming_stiffness(const Draw& draw, const Run&, const Bench&) {
  const double a = draw.size, T = 4 + 8 * draw.u;
  Hooks hooks;
  hooks.transmission = [=](const State& s) { return -a * saturating(s.t, T) * s.tau_elas; };
  return {hooks, {{"fraction", a, ""}, {"T", T, "s"}}};
}

Planted speed_times_cube(const Draw& draw, const Run&, const Bench&) {
  const double c = draw.size * (draw.u < 0.5 ? 1 : -1);
  return {link_torque([c](const State& s) { return c * s.qd * s.q * s.q * s.q; }),
          {{"coefficient", c, "N m s/rad^4"}}};
}

/// Something soft that the link leans on beyond 0.25 rad.
Planted wall(const Draw& draw, const Run&, const Bench&) {
  constexpr double kBegins = 0.25;
  const double k = draw.size;
  return {link_torque([k](const State& s) { return k * std::max(0.0, s.q - kBegins); }),
          {{"stiffness", k, "N m/rad"}}};
}

/// The frame of the pulleys gives way: 12 Hz, damping ratio 0.05.
Planted base_flexibility(const Draw& draw, const Run&, const Bench&) {
  const double compliance = draw.size, omega = kTwoPi * 12;
  struct Frame {
    double x = 0, v = 0;
    bool placed = false;
  };
  const auto frame = std::make_shared<Frame>();
  Hooks hooks;
  hooks.deflection = [=](const State&) { return frame->x; };
  hooks.advance = [=](const State& s) {
    const double rest = -compliance * s.tau_elas;
    if (!frame->placed) *frame = {rest, 0, true};
    frame->v += s.h * (omega * omega * (rest - frame->x) - 2 * 0.05 * omega * frame->v);
    frame->x += s.h * frame->v;
  };
  return {hooks, {{"compliance", compliance, "rad/(N m)"}, {"frequency", 12, "Hz"}}};
}

/// Friction of two levels that changes over at random, every 2 s on average.
Planted stepped_friction(const Draw& draw, const Run& run, const Bench&) {
  Random random(draw.seed, "steps " + run.name);
  const auto times = std::make_shared<std::vector<double>>();
  for (double t = -1; t < 1e-3 * static_cast<double>(run.reference.size()) + 1;) {
    t -= 2 * std::log(random.uniform(1e-6, 1));
    times->push_back(t);
  }
  const double a = draw.size;
  return {link_coulomb([=](const State& s) {
            const auto passed = std::upper_bound(times->begin(), times->end(), s.t);
            return a * ((passed - times->begin()) % 2 == 0 ? 1 : -1);
          }),
          {{"amplitude", a, "N m"}}};
}

/// A machine next door: one push every 1.3 s.
Planted neighbour(const Draw& draw, const Run&, const Bench&) {
  const double a = draw.size, phase = kTwoPi * draw.u;
  return {link_torque([=](const State& s) {
            const double x = std::sin(kTwoPi * s.t / 1.3 + phase);
            return x > 0 ? a * x * x * x : 0;
          }),
          {{"amplitude", a, "N m"}, {"period", 1.3, "s"}}};
}

/// Brownian torque: its sd after 10 s. Straight between whole ms.
Planted random_walk(const Draw& draw, const Run& run, const Bench&) {
  Random random(draw.seed, "walk " + run.name);
  const auto path = std::make_shared<std::vector<double>>();
  const double step = draw.size / std::sqrt(10 * kRate);
  double x = 0;
  for (std::size_t k = 0; k < run.reference.size() + 1002; ++k) {
    path->push_back(x);
    x += step * random.normal();
  }
  return {link_torque([path](const State& s) { return value_at(*path, s.t); }),
          {{"sd", draw.size, "N m"}}};
}

using enum Form;
constexpr auto kLink = Shows::link, kOpposite = Shows::opposite;

constexpr std::array kRows{
    Row{"acceleration_friction", "link", "", outside, "", 0.5, "N m", kLink,
        "Coulomb f_s + a tanh(qdd sgn v / (1 rad/s^2))", acceleration_friction},
    Row{"rest_friction", "link", "", outside, "", 1, "N m", kLink,
        "Coulomb f_s + a ln(1 + age/0.1 s), age' = 1 - |v| age/5 mrad", rest_friction},
    Row{"warming_stiffness", "transmission", "", outside, "", 0.03, "", kOpposite,
        "tau_elas (1 - a (1 - exp(-t/T)))", warming_stiffness},
    Row{"speed_times_cube", "link", "", outside, "", 20, "N m s/rad^4", kLink, "+ c qd q^3",
        speed_times_cube},
    Row{"wall", "link", "", outside, "", 10, "N m/rad", kLink, "+ k (q - 0.25 rad) where positive",
        wall},
    Row{"base_flexibility", "transmission", "", outside, "", 1e-4, "rad/(N m)", kOpposite,
        "tau_elas(phi + x), x'' + 2 0.05 w x' + w^2 x = -w^2 a tau_elas, 12 Hz", base_flexibility},
    Row{"stepped_friction", "link", "", outside, "", 0.4, "N m", kLink,
        "Coulomb f_s +- a, the sign changes at random times", stepped_friction},
    Row{"neighbour", "link", "", outside, "", 0.6, "N m", kLink,
        "+ a max(0, sin(2 pi t/1.3 s + p))^3", neighbour},
    Row{"random_walk", "link", "", outside, "", 0.5, "N m", kLink, "Brownian torque", random_walk},
};

}  // namespace

std::span<const Row> outside_law_rows() { return kRows; }

}  // namespace hidden
