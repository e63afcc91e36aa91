// Effects between the two sides: a torque on both with opposite sign.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "effects.hpp"

namespace hidden {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;
constexpr double kAt = 0.02;  // rad, the deflection at which sizes of stiffness are given

Hooks altered(std::function<void(Bench&)> alter) {
  Hooks hooks;
  hooks.alter = std::move(alter);
  return hooks;
}

Hooks deflected(std::function<double(const State&)> extra) {
  Hooks hooks;
  hooks.deflection = std::move(extra);
  return hooks;
}

Hooks pulled(std::function<double(const State&)> torque) {
  Hooks hooks;
  hooks.transmission = std::move(torque);
  return hooks;
}

Planted cable_damping(const Draw& draw, const Run&, const Bench&) {
  const double d = draw.size;
  return {pulled([d](const State& s) { return d * s.phid; }), {{"damping", d, "N m s/rad"}}};
}
Planted bent_damping(const Draw& draw, const Run&, const Bench&) {
  const double d = draw.size;
  return {
      pulled([d](const State& s) { return d * sign(s.phid) * std::pow(std::abs(s.phid), 0.7); }),
      {{"damping", d, "N m (s/rad)^0.7"}}};
}

/// Bouc-Wen with n = 1: dz/dphi = (1 - z sgn phid)/y, solved exactly for the way of a half step.
Planted hysteresis(const Draw& draw, const Run&, const Bench&) {
  const double a = draw.size, y = 4e-4 + 8e-4 * draw.u;
  const auto z = std::make_shared<double>(0);
  const auto after = [=](const State& s, double share) {
    const double toward = sign(s.phid);
    return toward + (*z - toward) * std::exp(-std::abs(s.phid) * share * s.h / y);
  };
  Hooks hooks = pulled([=](const State& s) { return a * after(s, 0.5); });
  hooks.advance = [=](const State& s) { *z = after(s, 1); };
  return {hooks, {{"amplitude", a, "N m"}, {"yield", y, "rad"}}};
}

/// Four Maxwell-slip elements of equal strength that yield one after the other.
Planted maxwell(const Draw& draw, const Run&, const Bench&) {
  constexpr std::array yields{0.3, 0.8, 1.8, 4.0};
  const double a = draw.size, y = 4e-4 + 6e-4 * draw.u;
  const auto z = std::make_shared<std::array<double, 4>>();
  const auto after = [=](const State& s, std::size_t i, double share) {
    return std::clamp((*z)[i] + s.phid * share * s.h / (y * yields[i]), -1.0, 1.0);
  };
  Hooks hooks = pulled([=](const State& s) {
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) sum += after(s, i, 0.5);
    return a * sum / 4;
  });
  hooks.advance = [=](const State& s) {
    for (std::size_t i = 0; i < 4; ++i) (*z)[i] = after(s, i, 1);
  };
  return {hooks, {{"amplitude", a, "N m"}, {"yield", y, "rad"}}};
}

template <int kPower>
Planted stiffness_order(const Draw& draw, const Run&, const Bench&) {
  const double c = draw.size / std::pow(kAt, kPower);
  return {altered([c](Bench& bench) {
            bench.rig.cable_1.c[kPower - 1] += c;
            bench.rig.cable_2.c[kPower - 1] += c;
          }),
          {{"coefficient", c, "N m/rad^" + std::to_string(kPower)}}};
}

Planted stiffness_asymmetry(const Draw& draw, const Run&, const Bench&) {
  const double a = draw.size;
  return {altered([a](Bench& bench) {
            for (double& c : bench.rig.cable_2.c) c *= 1 + a;
          }),
          {{"fraction", a, ""}}};
}

template <bool kTwo>
Planted eccentricity(const Draw& draw, const Run&, const Bench&) {
  const double a = draw.size, phase = kTwoPi * draw.u, phase_2 = kTwoPi * draw.w;
  const double second = kTwo ? 0.4 : 0;
  return {deflected([=](const State& s) {
            return a * (std::sin(s.q + phase) + second * std::sin(2 * s.q + phase_2));
          }),
          {{"amplitude", a, "rad"}, {"phase", phase, "rad"}}};
}

/// Standard linear solid(s) in series: the cable gives way by up to the share `a` of tau/k0.
template <bool kTwo>
Planted creep(const Draw& draw, const Run&, const Bench& bench) {
  const double a = draw.size, T = 1 + 3 * draw.u, k_0 = bench.rig.stiffness(kAt);
  const std::array<double, 2> times{kTwo ? 0.4 : T, 5.0};
  const std::array<double, 2> share{kTwo ? 0.5 : 1.0, kTwo ? 0.5 : 0.0};
  const auto c = std::make_shared<std::array<double, 2>>();
  Hooks hooks = deflected([c](const State&) { return -(*c)[0] - (*c)[1]; });
  hooks.advance = [=](const State& s) {
    for (std::size_t i = 0; i < 2; ++i)
      (*c)[i] += (share[i] * a * s.tau_elas / k_0 - (*c)[i]) * s.h / times[i];
  };
  std::vector<Coefficient> coefficients{{"compliance", a / k_0, "rad/(N m)"}};
  if (!kTwo) coefficients.push_back({"T", T, "s"});
  return {hooks, coefficients};
}

Planted dead_zone(const Draw& draw, const Run&, const Bench&) {
  const double b = draw.size;
  return {altered([b](Bench& bench) {
            bench.rig.cable_1.l_o -= b;
            bench.rig.cable_2.l_o -= b;
          }),
          {{"half_width", b, "rad"}}};
}
Planted round_dead_zone(const Draw& draw, const Run&, const Bench&) {
  const double b = draw.size;
  return {deflected([b](const State& s) {
            return b * sign(s.phi) * (std::exp(-std::abs(s.phi) / b) - 1);
          }),
          {{"half_width", b, "rad"}}};
}

Planted preload(const Draw& draw, const Run&, const Bench&) {
  const double l_o = draw.size;
  return {altered([l_o](Bench& bench) {
            bench.rig = preloaded(bench.rig, bench.rig.cable_1.l_o + l_o);
          }),
          {{"l_o", l_o, "rad"}}};
}

using enum Form;
constexpr auto kOpposite = Shows::opposite;

constexpr std::array kRows{
    Row{"cable_damping", "transmission", "", matched, "", 3, "N m s/rad", kOpposite,
        "tau_elas + d phid", cable_damping},
    Row{"cable_damping", "transmission", "", other, "power_0_7", 2, "N m (s/rad)^0.7", kOpposite,
        "tau_elas + d sgn(phid) |phid|^0.7", bent_damping},
    Row{"cable_hysteresis", "transmission", "", matched, "", 0.4, "N m", kOpposite,
        "tau_elas + a z, dz/dphi = (1 - z sgn phid)/y", hysteresis},
    Row{"cable_hysteresis", "transmission", "", other, "four_maxwell", 0.5, "N m", kOpposite,
        "tau_elas + a/4 times four elastic sliders", maxwell},
    Row{"stiffness_order", "transmission", "", matched, "", 4, "N m at 20 mrad", kOpposite,
        "+ c l^3 in each cable", stiffness_order<3>},
    Row{"stiffness_order", "transmission", "", other, "quartic", 4, "N m at 20 mrad", kOpposite,
        "+ c l^4 in each cable", stiffness_order<4>},
    Row{"stiffness_asymmetry", "transmission", "", matched, "", 0.2, "", Shows::nothing,
        "cable 2 times 1 + a: the base has two cables", stiffness_asymmetry, true},
    Row{"pulley_eccentricity", "transmission", "", matched, "", 3e-4, "rad", kOpposite,
        "tau_elas(phi + a sin(q + p))", eccentricity<false>},
    Row{"pulley_eccentricity", "transmission", "", other, "second_harmonic", 3e-4, "rad", kOpposite,
        "tau_elas(phi + a sin(q + p) + 0.4 a sin(2 q + p2))", eccentricity<true>},
    Row{"creep", "transmission", "", matched, "", 0.03, "", kOpposite,
        "tau_elas(phi - c), dc/dt = (a tau_elas/k0 - c)/T", creep<false>},
    Row{"creep", "transmission", "", other, "two_times", 0.04, "", kOpposite,
        "two of them, T 0.4 and 5 s", creep<true>},
    Row{"dead_zone", "transmission", "l_o", matched, "", 7e-4, "rad", kOpposite,
        "l_o = -b in both cables", dead_zone},
    Row{"dead_zone", "transmission", "l_o", other, "round", 7e-4, "rad", kOpposite,
        "tau_elas(phi - b sgn(phi) (1 - exp(-|phi|/b)))", round_dead_zone},
    Row{"preload", "transmission", "l_o", matched, "", 1e-3, "rad", kOpposite,
        "l_o > 0 in cable 1, balanced by cable 2", preload},
};

}  // namespace

std::span<const Row> transmission_rows() { return kRows; }

}  // namespace hidden
