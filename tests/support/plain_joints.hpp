// Logs of several joints by plain arithmetic: nothing here is shared with the library. Blocked logs
// are the static equations of prescribed sweeps; moving ones a Runge-Kutta integration (order 4,
// Abramowitz & Stegun 25.5.10) of links and motors under a sampled PD controller.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace cablefit::test {

/// Polynomial of the angle: c0 x + c1 x^2/2 + c2 x^3/3 and its derivative c0 + c1 x + c2 x^2.
struct PlainMap {
  std::vector<double> radius;
  double way(double x) const {
    double sum = 0;
    for (std::size_t k = 0; k < radius.size(); ++k)
      sum += radius[k] * std::pow(x, static_cast<double>(k) + 1) / (static_cast<double>(k) + 1);
    return sum;
  }
  double slope(double x) const {
    double sum = 0;
    for (std::size_t k = 0; k < radius.size(); ++k)
      sum += radius[k] * std::pow(x, static_cast<double>(k));
    return sum;
  }
};

/// What the path of a cable owes to two links together: it is longer by way[0] than with both at 0,
/// with the derivatives way[1] and way[2] by their angles.
struct PlainPath {
  std::size_t first = 0, second = 1;
  std::function<std::array<double, 3>(double, double)> way;
  std::string map;  ///< as a rig file has it
};

struct PlainCable {
  std::string name;
  std::vector<PlainMap> motor, link;  ///< per joint
  std::vector<double> k;              ///< force sum k_j l^(j+1), l > 0
  double l_o = 0;
  std::vector<PlainPath> paths = {};

  double force(const std::vector<double>& q, const std::vector<double>& theta) const {
    double l = l_o;
    for (std::size_t j = 0; j < motor.size(); ++j) l += motor[j].way(theta[j]) - link[j].way(q[j]);
    for (const PlainPath& path : paths) l += path.way(q[path.first], q[path.second])[0];
    if (l <= 0) return 0;
    double f = 0;
    for (std::size_t j = 0; j < k.size(); ++j) f += k[j] * std::pow(l, static_cast<double>(j) + 1);
    return f;
  }
};

struct PlainJoint {
  double J_link = 0.05, J_motor = 0.005, f_v = 0.05, f_s = 0.1, f_vm = 0.02, f_sm = 0.05;
  double offset = 0.03;
  double sweep = 0.2, sweep_rate = 0.05;  ///< blocked: amplitude rad, Hz
  double swing = 0.3;                     ///< moving: amplitude of the reference, rad
  double kp = 60, kd = 0.6;
  double load = 2;   ///< amplitude of a torque on the link, N m
  double noise = 1;  ///< of tau, times that of the rig
  double gain = 1;   ///< of the torque as it is logged
};

/// Link accelerations from link torques; empty: torque / J_link.
using LinkDynamics =
    std::function<std::vector<double>(const std::vector<double>& q, const std::vector<double>& qd,
                                      const std::vector<double>& torque)>;

/// Motion of all joints, n each.
struct PlainMotion {
  std::vector<double> q, qd, theta, thetad;
};

/// Adds torques, N m, to those that oppose the links and the motors.
using HiddenTorque = std::function<void(const PlainMotion& motion, std::vector<double>& link,
                                        std::vector<double>& motor)>;

struct PlainRig {
  std::vector<PlainJoint> joints;
  std::vector<PlainCable> cables;
  LinkDynamics link_dynamics;
  HiddenTorque hidden = {};
  double torque_noise = 0.05;   ///< sd, N m
  double load_noise = 0;        ///< sd of the sensor of tau_load, N m
  double quantum = 1.2e-5;      ///< of encoders of 19 bit, rad
  bool logs_reference = false;  ///< in moving logs

  std::size_t n() const { return joints.size(); }
};

inline std::vector<double> motor_torques(const PlainRig& rig, const std::vector<double>& q,
                                         const std::vector<double>& theta) {
  std::vector<double> torque(rig.n(), 0.0);
  for (const PlainCable& cable : rig.cables) {
    const double f = cable.force(q, theta);
    for (std::size_t j = 0; j < rig.n(); ++j) torque[j] += cable.motor[j].slope(theta[j]) * f;
  }
  return torque;
}

inline std::vector<double> link_torques(const PlainRig& rig, const std::vector<double>& q,
                                        const std::vector<double>& theta) {
  std::vector<double> torque(rig.n(), 0.0);
  for (const PlainCable& cable : rig.cables) {
    const double f = cable.force(q, theta);
    for (std::size_t j = 0; j < rig.n(); ++j) torque[j] += cable.link[j].slope(q[j]) * f;
    for (const PlainPath& path : cable.paths) {
      const std::array<double, 3> way = path.way(q[path.first], q[path.second]);
      torque[path.first] -= way[1] * f;
      torque[path.second] -= way[2] * f;
    }
  }
  return torque;
}

inline double sign_of(double x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

class PlainLog {
 public:
  PlainLog(const PlainRig& rig, unsigned seed, bool with_reference = false)
      : rig_(rig), random_(seed) {
    const auto add = [&](const char* name) {
      for (std::size_t j = 0; j < rig.n(); ++j)
        text_ += rig.n() > 1 ? fmt::format(",{}{}", name, j + 1) : fmt::format(",{}", name);
    };
    text_ = "t";
    for (const char* name : {"q", "theta", "tau", "tau_load"}) add(name);
    if (with_reference) add("theta_ref");
    text_ += '\n';
  }
  void add(double t, const std::vector<double>& q, const std::vector<double>& theta,
           const std::vector<double>& tau, const std::vector<double>& load,
           const std::vector<double>& reference = {}) {
    text_ += fmt::format("{:.4f}", t);
    for (const double x : q) text_ += fmt::format(",{:.9f}", stepped(x));
    for (const double x : theta) text_ += fmt::format(",{:.9f}", stepped(x));
    for (std::size_t j = 0; j < tau.size(); ++j)
      text_ +=
          fmt::format(",{:.6f}", rig_.joints[j].gain * tau[j] +
                                     rig_.torque_noise * rig_.joints[j].noise * normal_(random_));
    for (const double x : load)
      text_ +=
          fmt::format(",{:.6f}", rig_.load_noise > 0 ? x + rig_.load_noise * normal_(random_) : x);
    for (const double x : reference) text_ += fmt::format(",{:.9f}", x);
    text_ += '\n';
  }
  const std::string& text() const { return text_; }

 private:
  double stepped(double x) const { return std::round(x / rig_.quantum) * rig_.quantum; }

  const PlainRig& rig_;
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
  std::string text_;
};

/// All motors sweep at once about q + `ahead`, at rates without a common period, links held at `q`.
/// `hold`: s, how long the drive holds a torque; moving_log holds it 1 ms, until the next row.
inline std::string blocked_log(const PlainRig& rig, const std::vector<double>& q, double seconds,
                               unsigned seed, double rate = 200, double ahead = 0,
                               double hold = 0) {
  PlainLog log(rig, seed);
  for (int i = 0; i < static_cast<int>(seconds * rate); ++i) {
    const double t = i / rate;
    const auto theta_at = [&](double when) {
      std::vector<double> theta;
      for (std::size_t j = 0; j < rig.n(); ++j) {
        const double wt = 2 * M_PI * rig.joints[j].sweep_rate * when;
        // Two tones: the speed varies, so that viscous and static friction differ.
        theta.push_back(q[j] + ahead +
                        rig.joints[j].sweep *
                            (0.7 * std::sin(wt) + 0.3 * std::sin(2.7 * wt + 0.4)));
      }
      return theta;
    };
    const double acts = t + 0.5 * hold;
    const std::vector<double> recorded = theta_at(t), theta = theta_at(acts);
    std::vector<double> speed;
    for (std::size_t j = 0; j < rig.n(); ++j) {
      const double w = 2 * M_PI * rig.joints[j].sweep_rate;
      speed.push_back(rig.joints[j].sweep * w *
                      (0.7 * std::cos(w * acts) + 0.3 * 2.7 * std::cos(2.7 * w * acts + 0.4)));
    }
    std::vector<double> tau = motor_torques(rig, q, theta), on_link(rig.n(), 0.0);
    if (rig.hidden) rig.hidden({q, std::vector<double>(rig.n(), 0.0), theta, speed}, on_link, tau);
    for (std::size_t j = 0; j < rig.n(); ++j)
      tau[j] += rig.joints[j].offset + rig.joints[j].f_sm * sign_of(speed[j]) +
                rig.joints[j].f_vm * speed[j];
    log.add(t, q, recorded, tau, std::vector<double>(rig.n(), 0.0));
  }
  return log.text();
}

/// State: q, qd, theta, thetad, n each.
using PlainState = std::vector<double>;

inline std::vector<double> part(const PlainState& x, std::size_t n, std::size_t which) {
  const auto from = x.begin() + static_cast<std::ptrdiff_t>(which * n);
  return {from, from + static_cast<std::ptrdiff_t>(n)};
}

/// Torque on the link, known at every instant.
inline double load_at(const PlainRig& rig, std::size_t joint, double t) {
  const double shift = 0.7 * static_cast<double>(joint);
  return std::min(1.0, t) * rig.joints[joint].load *
         (std::sin(2 * M_PI * 0.23 * t + shift) + 0.5 * std::sin(2 * M_PI * 3.1 * t));
}

inline PlainState slope_of(const PlainRig& rig, const PlainState& x, double t,
                           const std::vector<double>& tau) {
  const std::size_t n = rig.n();
  const auto q = part(x, n, 0), qd = part(x, n, 1), theta = part(x, n, 2), thetad = part(x, n, 3);
  std::vector<double> link = link_torques(rig, q, theta), motor = motor_torques(rig, q, theta);
  PlainState slope(4 * n);
  if (rig.hidden) {
    std::vector<double> on_link(n, 0.0), on_motor(n, 0.0);
    rig.hidden({q, qd, theta, thetad}, on_link, on_motor);
    for (std::size_t j = 0; j < n; ++j) {
      link[j] -= on_link[j];
      motor[j] += on_motor[j];
    }
  }
  for (std::size_t j = 0; j < n; ++j) {
    const PlainJoint& joint = rig.joints[j];
    link[j] += load_at(rig, j, t) - joint.f_v * qd[j] - joint.f_s * sign_of(qd[j]);
    slope[j] = qd[j];
    slope[n + j] = link[j] / joint.J_link;
    slope[2 * n + j] = thetad[j];
    slope[3 * n + j] = (tau[j] - motor[j] - joint.offset - joint.f_vm * thetad[j] -
                        joint.f_sm * sign_of(thetad[j])) /
                       joint.J_motor;
  }
  if (rig.link_dynamics) {
    const std::vector<double> qdd = rig.link_dynamics(q, qd, link);
    for (std::size_t j = 0; j < n; ++j) slope[n + j] = qdd[j];
  }
  return slope;
}

inline PlainState runge_kutta(const PlainRig& rig, const PlainState& x, double t, double h,
                              const std::vector<double>& tau) {
  const auto moved = [&](const PlainState& k, double by) {
    PlainState y = x;
    for (std::size_t i = 0; i < y.size(); ++i) y[i] += by * k[i];
    return y;
  };
  const PlainState a = slope_of(rig, x, t, tau);
  const PlainState b = slope_of(rig, moved(a, h / 2), t + h / 2, tau);
  const PlainState c = slope_of(rig, moved(b, h / 2), t + h / 2, tau);
  const PlainState d = slope_of(rig, moved(c, h), t + h, tau);
  PlainState y = x;
  for (std::size_t i = 0; i < y.size(); ++i) y[i] += h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]);
  return y;
}

/// Multi-sine references under PD control at 1 kHz; the torque is held between samples.
inline std::string moving_log(const PlainRig& rig, double seconds, unsigned seed) {
  constexpr double kPeriod = 1e-3;
  constexpr int kSteps = 20;
  constexpr double kStep = kPeriod / kSteps;
  const std::size_t n = rig.n();
  PlainLog log(rig, seed, rig.logs_reference);
  PlainState x(4 * n, 0.0);
  std::vector<double> before(n, 0.0);
  for (int i = 0; i < static_cast<int>(seconds / kPeriod); ++i) {
    const double t = i * kPeriod;
    std::vector<double> tau(n), load(n), references(n);
    for (std::size_t j = 0; j < n; ++j) {
      const double fade = std::min(1.0, t);
      const double shift = 0.7 * static_cast<double>(j);
      const double reference = fade * rig.joints[j].swing *
                               (0.5 * std::sin(2 * M_PI * (0.31 + 0.07 * shift) * t) +
                                0.3 * std::sin(2 * M_PI * (0.83 + 0.11 * shift) * t + shift) +
                                0.2 * std::sin(2 * M_PI * (1.9 + 0.13 * shift) * t + 2 * shift) +
                                0.03 * std::sin(2 * M_PI * (7.3 + 0.9 * shift) * t));
      references[j] = reference;
      const double error = reference - x[2 * n + j];
      tau[j] = rig.joints[j].kp * error +
               (i > 0 ? rig.joints[j].kd * (error - before[j]) / kPeriod : 0.0);
      before[j] = error;
      load[j] = load_at(rig, j, t);
    }
    // The log has the torque that acts from t on, without noise added to what the motor does.
    log.add(t, part(x, n, 0), part(x, n, 2), tau, load,
            rig.logs_reference ? references : std::vector<double>());
    for (int step = 0; step < kSteps; ++step) x = runge_kutta(rig, x, t + step * kStep, kStep, tau);
  }
  return log.text();
}

}  // namespace cablefit::test
