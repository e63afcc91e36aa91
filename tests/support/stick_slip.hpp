// Motion of a plain rig with dry friction, by events: an axis slides one way or sticks, between
// events a Runge-Kutta integration (order 4) of smooth equations. Where a sliding axis comes to
// rest, the instant is bisected and what its axes do next is found by trying every pattern. Nothing
// here is shared with the library, which knows no events between axes and no patterns.
#pragma once

#include <Eigen/LU>
#include <cmath>
#include <vector>

#include "tests/support/plain_arm.hpp"
#include "tests/support/plain_joints.hpp"

namespace cablefit::test {

/// Links that `arm` couples and motors, under torques that are held.
class StickSlip {
 public:
  /// `state`: q, qd, theta, thetad.
  StickSlip(PlainRig rig, PlainArm arm, PlainState state)
      : rig_(std::move(rig)), arm_(std::move(arm)), x_(std::move(state)), modes_(2 * rig_.n(), 0) {}

  const PlainState& state() const { return x_; }
  int n_events() const { return n_events_; }

  /// On by `h` under these motor torques.
  void step(const std::vector<double>& tau, double h) {
    choose_modes(tau);
    while (h > 0) {
      const PlainState after = advanced(tau, h);
      if (!has_turned(after)) {
        x_ = after;
        return;
      }
      double low = 0, high = h;
      for (int i = 0; i < 60 && high - low > 1e-15; ++i) {
        const double middle = 0.5 * (low + high);
        (has_turned(advanced(tau, middle)) ? high : low) = middle;
      }
      const PlainState there = advanced(tau, high);
      for (std::size_t a = 0; a < modes_.size(); ++a)
        if (modes_[a] != 0 && there[velocity(a)] * modes_[a] <= 0) modes_[a] = 0;
      x_ = there;
      for (std::size_t a = 0; a < modes_.size(); ++a)
        if (modes_[a] == 0) x_[velocity(a)] = 0;
      ++n_events_;
      h -= high;
      choose_modes(tau);
    }
  }

 private:
  using Modes = std::vector<int>;  ///< links, then motors: 0 sticks, else the direction

  std::size_t velocity(std::size_t axis) const {
    return axis < rig_.n() ? rig_.n() + axis : 2 * rig_.n() + axis;
  }
  double level(std::size_t axis) const {
    return axis < rig_.n() ? rig_.joints[axis].f_s : rig_.joints[axis - rig_.n()].f_sm;
  }

  /// Accelerations, and what friction holds on the axes that stick.
  void act(const PlainState& x, const std::vector<double>& tau, const Modes& modes,
           Eigen::VectorXd& acceleration, Eigen::VectorXd& held) const {
    const std::size_t n = rig_.n();
    const auto size = static_cast<Eigen::Index>(n);
    const auto q = part(x, n, 0), theta = part(x, n, 2);
    const Eigen::Map<const Eigen::VectorXd> at(x.data(), size), qd(x.data() + n, size);
    const std::vector<double> link = link_torques(rig_, q, theta),
                              motor = motor_torques(rig_, q, theta);
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(size);
    const Eigen::VectorXd weight = arm_.torques(at, none, none);
    Eigen::MatrixXd mass(size, size);
    Eigen::VectorXd net = -arm_.torques(at, qd, none);
    acceleration = held = Eigen::VectorXd::Zero(2 * size);
    Eigen::MatrixXd equations = Eigen::MatrixXd::Identity(size, size);
    Eigen::VectorXd right = none;
    for (Eigen::Index k = 0; k < size; ++k) {
      const auto j = static_cast<std::size_t>(k);
      mass.col(k) = arm_.torques(at, none, Eigen::VectorXd::Unit(size, k)) - weight;
      net(k) += link[j] - rig_.joints[j].f_v * qd(k) - rig_.joints[j].f_s * modes[j];
    }
    for (Eigen::Index k = 0; k < size; ++k) {
      if (modes[static_cast<std::size_t>(k)] == 0) continue;
      equations.row(k) = mass.row(k);
      right(k) = net(k);
    }
    acceleration.head(size) = equations.partialPivLu().solve(right);
    held.head(size) = net - mass * acceleration.head(size);
    for (std::size_t j = 0; j < n; ++j) {
      const PlainJoint& joint = rig_.joints[j];
      const auto a = static_cast<Eigen::Index>(n + j);
      const double push =
          tau[j] - motor[j] - joint.offset - joint.f_vm * x[3 * n + j] - joint.f_sm * modes[n + j];
      if (modes[n + j] == 0) held(a) = push;
      if (modes[n + j] != 0) acceleration(a) = push / joint.J_motor;
    }
  }

  bool is_right(const std::vector<double>& tau, const Modes& modes) const {
    Eigen::VectorXd acceleration, held;
    act(x_, tau, modes, acceleration, held);
    for (std::size_t a = 0; a < modes.size(); ++a) {
      const auto k = static_cast<Eigen::Index>(a);
      if (x_[velocity(a)] != 0) continue;
      if (modes[a] == 0 ? std::abs(held(k)) > level(a) : acceleration(k) * modes[a] <= 0)
        return false;
    }
    return true;
  }

  /// What moves goes on; of what rests every pattern is tried, sticking first.
  void choose_modes(const std::vector<double>& tau) {
    for (std::size_t a = 0; a < modes_.size(); ++a)
      if (x_[velocity(a)] != 0) modes_[a] = x_[velocity(a)] > 0 ? 1 : -1;
    if (is_right(tau, modes_)) return;
    Modes tried = modes_;
    std::vector<std::size_t> rest;
    for (std::size_t a = 0; a < modes_.size(); ++a)
      if (x_[velocity(a)] == 0) rest.push_back(a);
    const auto n_patterns = static_cast<int>(std::pow(3, rest.size()));
    for (int pattern = 0; pattern < n_patterns; ++pattern) {
      int digits = pattern;
      for (const std::size_t a : rest) {
        tried[a] = digits % 3 == 2 ? -1 : digits % 3;
        digits /= 3;
      }
      if (!is_right(tau, tried)) continue;
      modes_ = tried;
      return;
    }
    throw std::logic_error("no pattern of sticking and sliding fits");
  }

  bool has_turned(const PlainState& after) const {
    for (std::size_t a = 0; a < modes_.size(); ++a)
      if (modes_[a] != 0 && after[velocity(a)] * modes_[a] < 0) return true;
    return false;
  }

  PlainState slope(const PlainState& x, const std::vector<double>& tau) const {
    Eigen::VectorXd acceleration, held;
    act(x, tau, modes_, acceleration, held);
    const std::size_t n = rig_.n();
    PlainState all(4 * n);
    for (std::size_t j = 0; j < n; ++j) {
      all[j] = x[n + j];
      all[n + j] = acceleration(static_cast<Eigen::Index>(j));
      all[2 * n + j] = x[3 * n + j];
      all[3 * n + j] = acceleration(static_cast<Eigen::Index>(n + j));
    }
    return all;
  }

  PlainState advanced(const std::vector<double>& tau, double h) const {
    const auto moved = [&](const PlainState& k, double by) {
      PlainState y = x_;
      for (std::size_t i = 0; i < y.size(); ++i) y[i] += by * k[i];
      return y;
    };
    const PlainState a = slope(x_, tau), b = slope(moved(a, h / 2), tau),
                     c = slope(moved(b, h / 2), tau), d = slope(moved(c, h), tau);
    PlainState y = x_;
    for (std::size_t i = 0; i < y.size(); ++i) y[i] += h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]);
    return y;
  }

  PlainRig rig_;
  PlainArm arm_;
  PlainState x_;
  Modes modes_;
  int n_events_ = 0;
};

}  // namespace cablefit::test
