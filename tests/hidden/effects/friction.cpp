// Friction of one side: what the catalogue calls by the same name on the link and on the motor.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "effects.hpp"

namespace hidden {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;

template <bool kMotor>
struct Own {
  static Side& side(Sides& sides) { return kMotor ? sides.motor : sides.link; }
  static double speed(const State& s) { return kMotor ? s.thetad : s.qd; }
  static double angle(const State& s) { return kMotor ? s.theta : s.q; }
  static double coulomb(const Rig& rig) { return kMotor ? rig.f_sm : rig.f_s; }
  static double viscous(const Rig& rig) { return kMotor ? rig.f_vm : rig.f_v; }
};

/// More (or less) Coulomb friction, by `more(state)` N m in both directions.
template <bool kMotor, typename More>
Hooks coulomb(More more) {
  Hooks hooks;
  hooks.sides = [more](const State& s, Sides& sides) {
    Side& side = Own<kMotor>::side(sides);
    const double extra = more(s);
    side.up += extra;
    side.down += extra;
  };
  return hooks;
}

/// A torque that resists.
template <bool kMotor, typename Torque>
Hooks torque(Torque value) {
  Hooks hooks;
  hooks.sides = [value](const State& s, Sides& sides) {
    Own<kMotor>::side(sides).torque += value(s);
  };
  return hooks;
}

Planted constant_torque(const Draw& draw, const Run&, const Bench&) {
  const double c = draw.size * (draw.u < 0.5 ? 1 : -1);
  return {torque<false>([c](const State&) { return c; }), {{"torque", c, "N m"}}};
}

template <bool kMotor>
Planted asymmetric_coulomb(const Draw& draw, const Run&, const Bench&) {
  const double a = draw.size * (draw.u < 0.5 ? 1 : -1);
  Hooks hooks;
  hooks.sides = [a](const State&, Sides& sides) {
    Own<kMotor>::side(sides).up += a;
    Own<kMotor>::side(sides).down -= a;
  };
  return {hooks, {{"half_difference", a, "N m"}}};
}

Planted gravity(double second, const Draw& draw) {
  const double a = draw.size, phase = kTwoPi * draw.u;
  return {torque<false>([=](const State& s) {
            return a * (std::sin(s.q + phase) + second * std::sin(2 * s.q + phase));
          }),
          {{"amplitude", a, "N m"}, {"phase", phase, "rad"}}};
}
Planted gravity_imbalance(const Draw& draw, const Run&, const Bench&) { return gravity(0, draw); }
Planted gravity_cable(const Draw& draw, const Run&, const Bench&) { return gravity(0.35, draw); }

template <bool kMotor>
Planted asymmetric_power(double power, const Draw& draw) {
  const double a = draw.size * (draw.u < 0.5 ? 1 : -1);
  return {torque<kMotor>(
              [=](const State& s) { return a * std::pow(std::abs(Own<kMotor>::speed(s)), power); }),
          {{"half_difference", a, "N m s/rad"}}};
}
template <bool kMotor>
Planted asymmetric_viscous(const Draw& draw, const Run&, const Bench&) {
  return asymmetric_power<kMotor>(1, draw);
}
template <bool kMotor>
Planted asymmetric_viscous_bent(const Draw& draw, const Run&, const Bench&) {
  return asymmetric_power<kMotor>(1.4, draw);
}

enum class Fall { gauss, lorentz, exponential };

template <bool kMotor, Fall kFall>
Planted stribeck(const Draw& draw, const Run&, const Bench&) {
  const double a = draw.size, v_s = 0.06 + 0.12 * draw.u;
  const auto excess = [=](const State& s) {
    const double x = std::abs(Own<kMotor>::speed(s)) / v_s;
    if (kFall == Fall::lorentz) return a / (1 + x * x);
    return a * std::exp(kFall == Fall::gauss ? -x * x : -x);
  };
  return {coulomb<kMotor>(excess), {{"amplitude", a, "N m"}, {"v_s", v_s, "rad/s"}}};
}

template <bool kMotor>
Planted drag_power(double power, const Draw& draw) {
  const double a = draw.size;
  return {torque<kMotor>([=](const State& s) {
            const double v = Own<kMotor>::speed(s);
            return a * sign(v) * std::pow(std::abs(v), power);
          }),
          {{"coefficient", a, "N m s^2/rad^2"}}};
}
template <bool kMotor>
Planted quadratic_drag(const Draw& draw, const Run&, const Bench&) {
  return drag_power<kMotor>(2, draw);
}
Planted drag_1_6(const Draw& draw, const Run&, const Bench&) { return drag_power<true>(1.6, draw); }

template <bool kMotor>
Planted nonlinear_viscous(const Draw& draw, const Run&, const Bench&) {
  const double a = draw.size, power = 0.35 + 0.3 * draw.u;
  return {coulomb<kMotor>(
              [=](const State& s) { return a * std::pow(std::abs(Own<kMotor>::speed(s)), power); }),
          {{"coefficient", a, "N m (s/rad)^exponent"}, {"exponent", power, ""}}};
}
template <bool kMotor>
Planted hyperbolic_drag(const Draw& draw, const Run&, const Bench&) {
  const double a = 2 * draw.size, v_0 = 0.3 + 0.4 * draw.u;
  return {coulomb<kMotor>([=](const State& s) {
            const double v = std::abs(Own<kMotor>::speed(s));
            return a * v / (v + v_0);
          }),
          {{"limit", a, "N m"}, {"v_0", v_0, "rad/s"}}};
}

/// Triangle wave of period 2 pi and height 1.
double triangle(double x) { return std::asin(std::sin(x)) * 2 / std::numbers::pi; }

template <bool kMotor, bool kTriangle>
Planted position_friction(const Draw& draw, const Run&, const Bench&) {
  const double a = draw.size, n = 14 + 12 * draw.u, phase = kTwoPi * draw.w;
  return {coulomb<kMotor>([=](const State& s) {
            const double x = n * Own<kMotor>::angle(s) + phase;
            return a * (kTriangle ? triangle(x) : std::sin(x));
          }),
          {{"amplitude", a, "N m"}, {"order", n, ""}, {"phase", phase, "rad"}}};
}

template <bool kMotor>
Planted tension_friction(const Draw& draw, const Run&, const Bench&) {
  const double mu = draw.size;
  return {coulomb<kMotor>([mu](const State& s) { return mu * s.tension; }), {{"mu", mu, ""}}};
}
template <bool kMotor>
Planted tension_1_25(const Draw& draw, const Run&, const Bench&) {
  const double mu = draw.size, at = 30;
  return {coulomb<kMotor>([=](const State& s) { return mu * at * std::pow(s.tension / at, 1.25); }),
          {{"mu", mu, ""}}};
}

/// Dahl 1968: dz/dx = (1 - z sgn v)/d, solved exactly for the way of each half step.
template <bool kMotor>
Planted presliding(const Draw& draw, const Run&, const Bench&) {
  const double d = draw.size;
  const auto z = std::make_shared<double>(0);
  const auto after = [=](const State& s, double share) {
    const double v = Own<kMotor>::speed(s), toward = sign(v);
    return toward + (*z - toward) * std::exp(-std::abs(v) * share * s.h / d);
  };
  Hooks hooks;
  hooks.replaces_coulomb = true;
  hooks.sides = [=](const State& s, Sides& sides) {
    Side& side = Own<kMotor>::side(sides);
    const double now = after(s, 0.5);
    side.torque += now * (now > 0 ? side.up : side.down);
    side.up = side.down = 0;
  };
  hooks.advance = [=](const State& s) { *z = after(s, 1); };
  return {hooks, {{"distance", d, "rad"}}};
}

/// Iwan 1966: three sliders in parallel, each elastic up to its own distance.
template <bool kMotor>
Planted sliders(const Draw& draw, const Run&, const Bench&) {
  constexpr std::array distance{0.35, 1.2, 3.0}, share{0.45, 0.35, 0.2};
  const double d = draw.size;
  const auto z = std::make_shared<std::array<double, 3>>();
  const auto after = [=](const State& s, std::size_t i, double part) {
    return std::clamp((*z)[i] + Own<kMotor>::speed(s) * part * s.h / (d * distance[i]), -1.0, 1.0);
  };
  Hooks hooks;
  hooks.replaces_coulomb = true;
  hooks.sides = [=](const State& s, Sides& sides) {
    double now = 0;
    for (std::size_t i = 0; i < 3; ++i) now += share[i] * after(s, i, 0.5);
    Side& side = Own<kMotor>::side(sides);
    side.torque += now * (now > 0 ? side.up : side.down);
    side.up = side.down = 0;
  };
  hooks.advance = [=](const State& s) {
    for (std::size_t i = 0; i < 3; ++i) (*z)[i] = after(s, i, 1);
  };
  return {hooks, {{"distance", d, "rad"}}};
}

template <bool kMotor, bool kRoot>
Planted friction_drift(const Draw& draw, const Run&, const Bench& bench) {
  const double a = draw.size, T = 4 + 8 * draw.u, f_v = Own<kMotor>::viscous(bench.rig);
  Hooks hooks;
  hooks.sides = [=](const State& s, Sides& sides) {
    const double g = kRoot ? std::sqrt(std::max(0.0, s.t) / 20) : saturating(s.t, T);
    Side& side = Own<kMotor>::side(sides);
    side.up *= 1 - a * g;
    side.down *= 1 - a * g;
    side.viscous -= a * g * f_v;
  };
  std::vector<Coefficient> coefficients{{"fraction", a, ""}};
  if (!kRoot) coefficients.push_back({"T", T, "s"});
  return {hooks, coefficients};
}

using enum Form;
constexpr auto kLink = Shows::link, kMotor = Shows::motor;

constexpr std::array kRows{
    Row{"constant_torque", "link", "constant", matched, "", 0.4, "N m", kLink, "+ c",
        constant_torque},
    Row{"asymmetric_coulomb", "link", "constant", matched, "", 0.4, "N m", kLink,
        "Coulomb f + a up, f - a down", asymmetric_coulomb<false>},
    Row{"asymmetric_coulomb", "motor", "constant", matched, "", 0.4, "N m", Shows::nothing,
        "Coulomb f + a up, f - a down: the base's offset", asymmetric_coulomb<true>, true},
    Row{"gravity_imbalance", "link", "", matched, "", 0.6, "N m", kLink, "+ a sin(q + p)",
        gravity_imbalance},
    Row{"gravity_imbalance", "link", "", other, "cable_loop", 0.6, "N m", kLink,
        "+ a (sin(q + p) + 0.35 sin(2 q + p))", gravity_cable},
    Row{"asymmetric_viscous", "link", "", matched, "", 0.5, "N m s/rad", kLink, "+ a |v|",
        asymmetric_viscous<false>},
    Row{"asymmetric_viscous", "motor", "", matched, "", 0.4, "N m s/rad", kMotor, "+ a |v|",
        asymmetric_viscous<true>},
    Row{"asymmetric_viscous", "link", "", other, "bent", 0.5, "N m (s/rad)^1.4", kLink,
        "+ a |v|^1.4", asymmetric_viscous_bent<false>},
    Row{"asymmetric_viscous", "motor", "", other, "bent", 0.4, "N m (s/rad)^1.4", kMotor,
        "+ a |v|^1.4", asymmetric_viscous_bent<true>},
    Row{"stribeck", "link", "", matched, "", 0.8, "N m", kLink, "+ a sgn v exp(-(v/v_s)^2)",
        stribeck<false, Fall::gauss>},
    Row{"stribeck", "motor", "", matched, "", 0.6, "N m", kMotor, "+ a sgn v exp(-(v/v_s)^2)",
        stribeck<true, Fall::gauss>},
    Row{"stribeck", "link", "", other, "exponential", 0.8, "N m", kLink, "+ a sgn v exp(-|v|/v_s)",
        stribeck<false, Fall::exponential>},
    Row{"stribeck", "motor", "", other, "lorentzian", 0.6, "N m", kMotor,
        "+ a sgn v / (1 + (v/v_s)^2)", stribeck<true, Fall::lorentz>},
    Row{"quadratic_drag", "link", "", matched, "", 0.6, "N m s^2/rad^2", kLink, "+ a v |v|",
        quadratic_drag<false>},
    Row{"quadratic_drag", "motor", "", matched, "", 0.4, "N m s^2/rad^2", kMotor, "+ a v |v|",
        quadratic_drag<true>},
    Row{"quadratic_drag", "motor", "", other, "power_1_6", 0.5, "N m (s/rad)^1.6", kMotor,
        "+ a sgn v |v|^1.6", drag_1_6},
    Row{"nonlinear_viscous", "link", "", matched, "", 1.2, "N m (s/rad)^p", kLink,
        "+ a sgn v |v|^p, p 0.35 to 0.65", nonlinear_viscous<false>},
    Row{"nonlinear_viscous", "motor", "", matched, "", 1.2, "N m (s/rad)^p", kMotor,
        "+ a sgn v |v|^p, p 0.35 to 0.65", nonlinear_viscous<true>},
    Row{"nonlinear_viscous", "link", "", other, "hyperbolic", 0.8, "N m", kLink,
        "+ 2 a v / (|v| + v_0)", hyperbolic_drag<false>},
    Row{"nonlinear_viscous", "motor", "", other, "hyperbolic", 0.8, "N m", kMotor,
        "+ 2 a v / (|v| + v_0)", hyperbolic_drag<true>},
    Row{"position_friction", "link", "", matched, "", 0.6, "N m", kLink,
        "+ a sgn v sin(n q + p), n 14 to 26", position_friction<false, false>},
    Row{"position_friction", "motor", "", matched, "", 0.5, "N m", kMotor,
        "+ a sgn v sin(n theta + p), n 14 to 26", position_friction<true, false>},
    Row{"position_friction", "link", "", other, "triangle", 0.6, "N m", kLink,
        "+ a sgn v triangle(n q + p)", position_friction<false, true>},
    Row{"position_friction", "motor", "", other, "triangle", 0.5, "N m", kMotor,
        "+ a sgn v triangle(n theta + p)", position_friction<true, true>},
    Row{"tension_friction", "link", "", matched, "", 0.04, "", kLink, "+ mu (T1 + T2) sgn v",
        tension_friction<false>},
    Row{"tension_friction", "motor", "", matched, "", 0.04, "", kMotor, "+ mu (T1 + T2) sgn v",
        tension_friction<true>},
    Row{"tension_friction", "motor", "", other, "power_1_25", 0.04, "", kMotor,
        "+ mu 30 ((T1 + T2)/30)^1.25 sgn v", tension_1_25<true>},
    Row{"tension_friction", "link", "", other, "power_1_25", 0.04, "", kLink,
        "+ mu 30 ((T1 + T2)/30)^1.25 sgn v", tension_1_25<false>},
    Row{"presliding", "link", "", matched, "", 6e-3, "rad", kLink, "f_s z, dz/dq = (1 - z sgn v)/d",
        presliding<false>},
    Row{"presliding", "motor", "", matched, "", 6e-3, "rad", kMotor,
        "f_sm z, dz/dtheta = (1 - z sgn v)/d", presliding<true>},
    Row{"presliding", "link", "", other, "three_sliders", 6e-3, "rad", kLink,
        "f_s times three elastic sliders of 0.35 d, 1.2 d, 3 d", sliders<false>},
    Row{"presliding", "motor", "", other, "three_sliders", 6e-3, "rad", kMotor,
        "f_sm times three elastic sliders of 0.35 d, 1.2 d, 3 d", sliders<true>},
    Row{"friction_drift", "link", "", matched, "", 0.25, "", kLink,
        "friction times 1 - a (1 - exp(-t/T))", friction_drift<false, false>},
    Row{"friction_drift", "motor", "", matched, "", 0.25, "", kMotor,
        "friction times 1 - a (1 - exp(-t/T))", friction_drift<true, false>},
    Row{"friction_drift", "motor", "", other, "root", 0.25, "", kMotor,
        "friction times 1 - a sqrt(t/20 s)", friction_drift<true, true>},
    Row{"friction_drift", "link", "", other, "root", 0.25, "", kLink,
        "friction times 1 - a sqrt(t/20 s)", friction_drift<false, true>},
};

}  // namespace

std::span<const Row> friction_rows() { return kRows; }

}  // namespace hidden
