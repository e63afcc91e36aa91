// Effects to hide on one joint of several, by formulas of their own: nothing here is shared with
// the library.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>

#include "tests/support/plain_rigs.hpp"

namespace cablefit::test {

/// The rig has no place for the effect.
struct NotPossible : std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// `size`: of its torque, in parts of the dry friction of the axis it acts on.
struct JointEffect {
  std::string name, side;
  std::function<void(PlainRig& rig, std::size_t joint, double size)> hide;
};

/// Torque of an axis against its motion: level (N m) of the effect, position, speed.
using AxisTorque = double (*)(double level, double x, double v);

inline JointEffect on_axis(const std::string& name, const std::string& side, AxisTorque torque) {
  const bool on_link = side == "link";
  return {name, side, [=](PlainRig& rig, std::size_t joint, double size) {
            const PlainJoint& own = rig.joints[joint];
            const double level = size * (on_link ? own.f_s : own.f_sm);
            rig.hidden = [=](const PlainMotion& m, std::vector<double>& link,
                             std::vector<double>& motor) {
              if (on_link)
                link[joint] += torque(level, m.q[joint], m.qd[joint]);
              else
                motor[joint] += torque(level, m.theta[joint], m.thetad[joint]);
            };
          }};
}

/// Friction of a cable on its motor pulley: a share of its tension.
inline void hide_tension_friction(PlainRig& rig, std::size_t joint, double size) {
  double at_rest = 0;
  const std::vector<double> zero(rig.n(), 0.0);
  const auto cables = rig.cables;
  const auto tension = [cables, joint](const std::vector<double>& q,
                                       const std::vector<double>& theta) {
    double sum = 0;
    for (const PlainCable& cable : cables)
      sum += std::abs(cable.motor[joint].slope(theta[joint])) * cable.force(q, theta);
    return sum;
  };
  at_rest = tension(zero, zero);
  const double mu = size * rig.joints[joint].f_sm / at_rest;
  rig.hidden = [=](const PlainMotion& m, std::vector<double>&, std::vector<double>& motor) {
    motor[joint] += mu * (tension(m.q, m.theta) - at_rest) * sign_of(m.thetad[joint]);
  };
}

/// Between motor and link; a rate of 1 rad/s of their difference makes `size` of the friction.
inline void hide_cable_damping(PlainRig& rig, std::size_t joint, double size) {
  const double d = size * rig.joints[joint].f_sm;
  rig.hidden = [=](const PlainMotion& m, std::vector<double>& link, std::vector<double>& motor) {
    const double torque = d * (m.thetad[joint] - m.qd[joint]);
    motor[joint] += torque;
    link[joint] -= torque;
  };
}

/// Round pulleys of one joint, on either side.
inline PlainMap& pulley_of(PlainCable& cable, bool on_link, std::size_t joint) {
  return (on_link ? cable.link : cable.motor)[joint];
}

inline bool has_pulley(PlainCable& cable, bool on_link, std::size_t joint) {
  const PlainMap& map = pulley_of(cable, on_link, joint);
  return map.radius.size() == 1 && map.radius.front() != 0;
}

/// A pulley that is larger than the rig file says.
inline void hide_radius(PlainRig& rig, bool on_link, std::size_t joint, double size) {
  for (PlainCable& cable : rig.cables)
    if (has_pulley(cable, on_link, joint)) {
      pulley_of(cable, on_link, joint).radius.front() *= 1 + 0.04 * size;
      return;
    }
  throw NotPossible("no round pulley on the joint");
}

/// A cable that the joint moves although the rig file lets it pass. It moves with the next joint.
inline void forget_radius(PlainRig& rig, std::size_t joint, double size) {
  for (PlainCable& cable : rig.cables)
    if (cable.link[joint].radius.front() == 0 && joint + 1 < rig.n() &&
        cable.link[joint + 1].radius.front() != 0) {
      pulley_of(cable, true, joint) = round_map(0.003 * size);
      return;
    }
  throw NotPossible("every cable of the next joint moves with this one");
}

/// Every cable rubs on the pulleys of the joints that it passes: on the pulley of joint k it loses
/// a share of its tension against its speed there, which all joints from k on make.
inline void hide_path_friction(PlainRig& rig, std::size_t joint, double size) {
  const auto cables = rig.cables;
  const std::size_t n = rig.n();
  const std::vector<double> zero(n, 0.0);
  double at_rest = 0;
  for (const PlainCable& cable : cables)
    at_rest += std::abs(cable.link[joint].slope(0)) * cable.force(zero, zero);
  const double mu = size * rig.joints[joint].f_s / at_rest;
  rig.hidden = [=](const PlainMotion& m, std::vector<double>& link, std::vector<double>&) {
    for (const PlainCable& cable : cables) {
      const double force = cable.force(m.q, m.theta);
      double speed = 0;
      for (std::size_t k = n; k-- > 0;) {  // from the tip
        const double radius = cable.link[k].slope(m.q[k]);
        if (radius == 0) continue;
        speed += radius * m.qd[k];
        for (std::size_t j = k; j < n; ++j)
          link[j] += mu * force * cable.link[j].slope(m.q[j]) * sign_of(speed);
      }
    }
  };
}

/// The base leans by 0.1 rad times `size`, each time about another level axis.
inline void lean(PlainRig& rig, std::size_t joint, double size) {
  PlainArm* arm = rig.link_dynamics.target<PlainArm>();
  if (arm == nullptr) throw NotPossible("the links have no weight");
  const double about[] = {0, 1.5707963267948966, 2.5};
  const double angle = 0.1 * size, heading = about[joint % 3];
  const Eigen::Vector3d axis(std::cos(heading), std::sin(heading), 0);
  arm->gravity = Eigen::AngleAxisd(angle, axis) * arm->gravity;
}

inline const std::vector<JointEffect>& joint_effects() {
  const auto stribeck = [](double a, double, double v) {
    return a * sign_of(v) * std::exp(-std::pow(v / 0.3, 2));
  };
  const auto drag = [](double a, double, double v) { return 0.3 * a * v * std::abs(v); };
  const auto uneven = [](double a, double, double v) { return 0.4 * a * std::max(v, 0.0); };
  const auto place = [](double a, double x, double v) {
    return 0.7 * a * sign_of(v) * (std::sin(9 * x) + 0.5 * std::cos(9 * x));
  };
  static const std::vector<JointEffect> all = {
      on_axis("stribeck", "motor", stribeck),
      on_axis("stribeck", "link", stribeck),
      on_axis("quadratic_drag", "motor", drag),
      on_axis("quadratic_drag", "link", drag),
      on_axis("asymmetric_viscous", "motor", uneven),
      on_axis("asymmetric_viscous", "link", uneven),
      on_axis("position_friction", "motor", place),
      on_axis("position_friction", "link", place),
      on_axis("asymmetric_coulomb", "motor",
              [](double a, double, double v) { return 0.5 * a * std::abs(sign_of(v)); }),
      on_axis("gravity_imbalance", "link",
              [](double a, double x, double) { return a * std::sin(x + 0.4); }),
      on_axis("cogging", "motor", [](double a, double x, double) { return a * std::sin(40 * x); }),
      on_axis("nonlinear_viscous", "motor",
              [](double a, double, double v) { return a * sign_of(v) * std::cbrt(std::abs(v)); }),
      {"tension_friction", "motor", hide_tension_friction},
      {"path_friction", "link", hide_path_friction},
      {"cable_damping", "transmission", hide_cable_damping},
      {"cable_radius", "link",
       [](PlainRig& rig, std::size_t joint, double size) { hide_radius(rig, true, joint, size); }},
      {"cable_radius", "motor",
       [](PlainRig& rig, std::size_t joint, double size) { hide_radius(rig, false, joint, size); }},
      {"forgotten_radius", "link", forget_radius},
      {"gravity_direction", "link", lean},
      {"torque_gain", "drive", [](PlainRig& rig, std::size_t joint, double size) {
         rig.joints[joint].gain = 1 + 0.2 * size;
       }}};
  return all;
}

inline const JointEffect& find_joint_effect(const std::string& name, const std::string& side) {
  for (const JointEffect& effect : joint_effects())
    if (effect.name == name && effect.side == side) return effect;
  throw std::invalid_argument("no effect " + name + " (" + side + ")");
}

}  // namespace cablefit::test
