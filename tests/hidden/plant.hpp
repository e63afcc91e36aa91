// The rig of Fichera & Grossard 2017 as the hidden-effect data knows it: one link, one motor, two
// antagonist cables. Shares no code with the library. SI; torques and angles after the reduction.
//
//   J_link  qdd     + f_v  qd     + f_s  Sgn(qd)              = tau_elas + tau_load
//   J_motor thetadd + f_vm thetad + f_sm Sgn(thetad) + offset = tau - tau_elas
#pragma once

#include <array>
#include <cstdint>
#include <functional>

namespace hidden {

/// A cable in joint space: torque = c[0] l + c[1] l^2 + ... (N m) for elongations l > 0 (rad), else
/// 0, because a cable only pulls.
struct Cable {
  std::array<double, 4> c{};
  double l_o = 0;  ///< elongation at zero deflection, rad; negative: slack

  double torque(double l) const {
    return l > 0 ? l * (c[0] + l * (c[1] + l * (c[2] + l * c[3]))) : 0;
  }
  /// d torque / d l, N m/rad.
  double stiffness(double l) const {
    return l > 0 ? c[0] + l * (2 * c[1] + l * (3 * c[2] + l * 4 * c[3])) : 0;
  }
};

struct Rig {
  double J_link = 0.339, f_v = 5.601, f_s = 3.274;
  double J_motor = 0.0133, f_vm = 1.0654, f_sm = 2.778, offset = 0.0286;
  Cable cable_1{{1367.7, 37844.1}};
  Cable cable_2{{1575.3, 29357.2}};

  /// Torque on the link (N m) and the sum of both cables' pull (N m) at the deflection phi (rad).
  double tau_elas(double phi) const {
    return cable_1.torque(phi + cable_1.l_o) - cable_2.torque(cable_2.l_o - phi);
  }
  double tension(double phi) const {
    return cable_1.torque(phi + cable_1.l_o) + cable_2.torque(cable_2.l_o - phi);
  }
  /// d tau_elas / d phi, N m/rad.
  double stiffness(double phi) const {
    return cable_1.stiffness(phi + cable_1.l_o) + cable_2.stiffness(cable_2.l_o - phi);
  }
};

/// Table 2 (low, poly) and Table 1 (low, poly), every number times 1 + 0.15 u, u uniform in +-1 by
/// seed. Seed 0: the paper's numbers.
Rig rig_of_seed(std::uint64_t seed);

/// The same cables stretched: cable 1 by l_o (rad), cable 2 by what balances it.
Rig preloaded(Rig rig, double l_o);

/// Deflection (rad) at which tau_elas is `torque` (N m).
double deflection_for(const Rig& rig, double torque);

/// Sensors, drive and controller. The controller is tau = kp e + kd (difference of e)/T on the
/// quantised motor encoder, held over T = 1 ms.
struct Bench {
  Rig rig;
  double kp = 300, kd = 6, limit = 250;  // N m/rad, N m s/rad, N m
  double quantum_q = 48e-6, quantum_theta = 24e-6, noise_tau = 0.3;
  double slow_noise_tau = 0;                 ///< N m, sd; correlation time 0.2 s
  double theta_scale = 0, theta_offset = 0;  ///< true theta = (1 + scale) measured + offset
  double q_delay = 0;                        ///< the link encoder shows q(t - delay), s
  double tau_delay = 0;                      ///< a command acts this much later, s
  double load_scale = 0;                     ///< true load = (1 + scale) logged
  std::function<double(double)> drive;       ///< what acts of a commanded torque; empty: all of it
};

}  // namespace hidden
