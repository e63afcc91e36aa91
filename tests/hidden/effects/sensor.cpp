// What encoders and clocks get wrong. The controller sees the wrong motor encoder as well.
#include <algorithm>
#include <array>
#include <cmath>

#include "effects.hpp"

namespace hidden {
namespace {

/// Delays are whole steps of the integrator, so that the truth is exact.
double on_grid(double delay) {
  const double h = 1 / (kRate * kSubsteps);
  return h * std::max(1.0, std::round(delay / h));
}

template <double Bench::*kMember>
Hooks set(double value) {
  Hooks hooks;
  hooks.alter = [value](Bench& bench) { bench.*kMember += value; };
  return hooks;
}

Planted encoder_scale(const Draw& draw, const Run&, const Bench&) {
  const double a = draw.size * (draw.u < 0.5 ? 1 : -1);
  return {set<&Bench::theta_scale>(a), {{"scale", a, ""}}};
}

Planted encoder_offset(const Draw& draw, const Run&, const Bench&) {
  const double a = draw.size * (draw.u < 0.5 ? 1 : -1);
  return {set<&Bench::theta_offset>(a), {{"offset", a, "rad"}}};
}

Planted encoder_delay(const Draw& draw, const Run&, const Bench&) {
  const double d = on_grid(draw.size);
  return {set<&Bench::q_delay>(d), {{"delay", d, "s"}}};
}

Planted torque_delay(const Draw& draw, const Run&, const Bench&) {
  const double d = on_grid(draw.size);
  return {set<&Bench::tau_delay>(d), {{"delay", d, "s"}}};
}

using enum Form;

constexpr std::array kRows{
    Row{"encoder_scale", "sensor", "", matched, "", 1e-3, "", Shows::opposite,
        "true theta = (1 + a) logged", encoder_scale},
    Row{"encoder_offset", "sensor", "", matched, "", 3e-4, "rad", Shows::opposite,
        "true theta = logged + a", encoder_offset},
    Row{"encoder_delay", "sensor", "", matched, "", 1.5e-3, "s", Shows::both,
        "logged q = true q(t - d)", encoder_delay},
    Row{"torque_delay", "sensor", "", matched, "", 1e-3, "s", Shows::motor, "acts: tau(t - d)",
        torque_delay},
};

}  // namespace

std::span<const Row> sensor_rows() { return kRows; }

}  // namespace hidden
