// What the drive does to the torque: ripple, losses, gain, limits.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "effects.hpp"

namespace hidden {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;

template <typename Torque>
Hooks motor_torque(Torque value) {
  Hooks hooks;
  hooks.sides = [value](const State& s, Sides& sides) { sides.motor.torque += value(s); };
  return hooks;
}

/// Changes what acts of a command, after what other effects already do to it.
template <typename Map>
Hooks acts(Map map) {
  Hooks hooks;
  hooks.alter = [map](Bench& bench) {
    bench.drive = [map, before = bench.drive](double tau) {
      return map(before ? before(tau) : tau);
    };
  };
  return hooks;
}

Planted ripple(const Draw& draw, double n, double second) {
  const double a = draw.size, phase = kTwoPi * draw.w;
  return {motor_torque([=](const State& s) {
            const double x = n * s.theta + phase;
            return a * (std::sin(x) + second * std::sin(2 * x + 1));
          }),
          {{"amplitude", a, "N m"}, {"order", n, ""}, {"phase", phase, "rad"}}};
}

template <bool kTwo>
Planted cogging(const Draw& draw, const Run&, const Bench&) {
  return ripple(draw, 12 + 20 * draw.u, kTwo ? 0.5 : 0);
}

/// Of a motor behind a reduction: dozens of periods in the range.
Planted geared_cogging(const Draw& draw, const Run&, const Bench&) {
  return ripple(draw, 200 + 100 * draw.u, 0);
}

/// The motor's share of a lossy screw: it gives (1 + a) tau_elas while it drives and tau_elas while
/// it is driven; set-valued in between.
Planted drive_efficiency(const Draw& draw, const Run&, const Bench&) {
  const double a = draw.size;
  Hooks hooks;
  hooks.sides = [a](const State& s, Sides& sides) {
    (s.tau_elas > 0 ? sides.motor.up : sides.motor.down) += a * std::abs(s.tau_elas);
  };
  return {hooks, {{"loss", a, ""}}};
}

Planted torque_gain(const Draw& draw, const Run&, const Bench&) {
  const double a = draw.size * (draw.u < 0.5 ? 1 : -1);
  return {acts([a](double tau) { return (1 + a) * tau; }), {{"gain", a, ""}}};
}

Planted load_scale(const Draw& draw, const Run&, const Bench&) {
  const double a = draw.size * (draw.u < 0.5 ? 1 : -1);
  Hooks hooks;
  hooks.alter = [a](Bench& bench) { bench.load_scale += a; };
  return {hooks, {{"scale", a, ""}}};
}

/// Clips at a level below the largest command of the case.
template <bool kSoft>
Planted saturation(const Draw& draw, const Run&, const Bench&) {
  const double limit = draw.peak_tau * (1 - std::min(0.6, draw.size));
  const auto clip = [limit](double tau) {
    if (!kSoft) return std::clamp(tau, -limit, limit);
    return tau / std::pow(1 + std::pow(std::abs(tau) / limit, 12), 1.0 / 12);
  };
  return {acts(clip), {{"limit", limit, "N m"}}};
}

Planted dead_band(const Draw& draw, const Run&, const Bench&) {
  const double b = draw.size;
  return {acts([b](double tau) { return tau - std::clamp(tau, -b, b); }), {{"band", b, "N m"}}};
}

template <bool kLine>
Planted offset_drift(const Draw& draw, const Run&, const Bench&) {
  const double a = draw.size, T = 4 + 8 * draw.u;
  std::vector<Coefficient> coefficients{{"amplitude", a, "N m"}};
  if (!kLine) coefficients.push_back({"T", T, "s"});
  return {motor_torque([=](const State& s) {
            return a * (kLine ? std::max(0.0, s.t) / 20 : saturating(s.t, T));
          }),
          coefficients};
}

using enum Form;

constexpr std::array kRows{
    Row{"cogging", "motor", "", matched, "", 0.3, "N m", Shows::motor,
        "+ a sin(n theta + p), n 12 to 32", cogging<false>},
    Row{"cogging", "motor", "", other, "two_harmonics", 0.3, "N m", Shows::motor,
        "+ a (sin(n theta + p) + 0.5 sin(2 n theta + 2 p + 1))", cogging<true>},
    Row{"cogging", "motor", "", other, "geared", 0.3, "N m", Shows::motor,
        "+ a sin(n theta + p), n 200 to 300", geared_cogging},
    Row{"drive_efficiency", "motor", "", matched, "", 0.06, "", Shows::motor,
        "+ a tau_elas while tau_elas thetad > 0", drive_efficiency},
    Row{"torque_gain", "drive", "scale", matched, "", 0.02, "", Shows::motor,
        "true tau = (1 + a) logged", torque_gain},
    Row{"load_scale", "link", "scale", matched, "", 0.02, "", Shows::link,
        "true tau_load = (1 + a) logged", load_scale},
    Row{"saturation", "drive", "", matched, "", 0.15, "", Shows::motor,
        "acts: clip(tau, (1 - a) largest tau)", saturation<false>},
    Row{"saturation", "drive", "", other, "soft", 0.15, "", Shows::motor,
        "acts: tau (1 + |tau/limit|^12)^(-1/12)", saturation<true>},
    Row{"drive_dead_band", "drive", "", matched, "", 0.8, "N m", Shows::motor,
        "acts: tau - clip(tau, b)", dead_band},
    Row{"offset_drift", "sensor", "", matched, "", 0.4, "N m", Shows::motor,
        "tau zero: + a (1 - exp(-t/T))", offset_drift<false>},
    Row{"offset_drift", "sensor", "", other, "line", 0.6, "N m", Shows::motor,
        "tau zero: + a t/20 s", offset_drift<true>},
};

}  // namespace

std::span<const Row> drive_rows() { return kRows; }

}  // namespace hidden
