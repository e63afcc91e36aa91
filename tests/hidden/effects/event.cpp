// What happens once, in one of the runs. A slip and a payload stay for the runs after it.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "effects.hpp"

namespace hidden {
namespace {

bool has_happened(const Draw& draw, const Run& run, double t) {
  return run.number > draw.event_run || (run.number == draw.event_run && t >= draw.event_time);
}

/// At once, or within 0.3 s.
template <bool kGradual>
Planted slip(const Draw& draw, const Run& run, const Bench&) {
  const double a = draw.size * (draw.u < 0.5 ? 1 : -1);
  Hooks hooks;
  hooks.deflection = [=, before = run](const State& s) {
    if (!has_happened(draw, before, s.t)) return 0.0;
    const bool is_over = before.number > draw.event_run;
    return kGradual && !is_over ? a * std::min(1.0, (s.t - draw.event_time) / 0.3) : a;
  };
  return {hooks, {{"slip", a, "rad"}, {"t0", draw.event_time, "s"}}};
}

/// A push on the link: raised cosine, or a knock that dies away.
template <bool kKnock>
Planted contact(const Draw& draw, const Run& run, const Bench&) {
  const double a = draw.size, width = 0.15 + 0.2 * draw.u, t_0 = draw.event_time;
  Hooks hooks;
  if (run.number == draw.event_run) {
    hooks.sides = [=](const State& s, Sides& sides) {
      const double x = (s.t - t_0) / width;
      if (x < 0 || x > (kKnock ? 20 : 1)) return;
      sides.link.torque -=
          kKnock ? a * std::exp(-x / 0.4) : 0.5 * a * (1 - std::cos(2 * std::numbers::pi * x));
    };
  }
  return {hooks, {{"torque", a, "N m"}, {"t0", t_0, "s"}, {"width", width, "s"}}};
}

/// A mass on the lever that was not there before.
Planted payload(const Draw& draw, const Run& run, const Bench&) {
  const double torque = draw.size, inertia = draw.size * 0.03, phase = 0.5 * (draw.u - 0.5);
  Hooks hooks;
  hooks.sides = [=, before = run](const State& s, Sides& sides) {
    if (!has_happened(draw, before, s.t)) return;
    sides.link.torque += torque * std::cos(s.q + phase);
    sides.link.inertia += inertia;
  };
  return {
      hooks,
      {{"torque", torque, "N m"}, {"inertia", inertia, "kg m^2"}, {"t0", draw.event_time, "s"}}};
}

using enum Form;

constexpr std::array kRows{
    Row{"slip", "transmission", "", matched, "", 5e-4, "rad", Shows::opposite,
        "tau_elas(phi + a) from t0 on", slip<false>},
    Row{"slip", "transmission", "", other, "gradual", 5e-4, "rad", Shows::opposite,
        "tau_elas(phi + a (t - t0)/0.3 s), then a", slip<true>},
    Row{"contact", "link", "", matched, "", 3, "N m", Shows::link,
        "- a (1 - cos(2 pi (t - t0)/w))/2 for w s", contact<false>},
    Row{"contact", "link", "", other, "knock", 4, "N m", Shows::link, "- a exp(-(t - t0)/(0.4 w))",
        contact<true>},
    Row{"payload_change", "link", "", matched, "", 1, "N m", Shows::link,
        "+ a cos(q + p) + 0.03 s^2 a qdd from t0 on", payload},
};

}  // namespace

std::span<const Row> event_rows() { return kRows; }

}  // namespace hidden
