// From a window of raw samples to smooth positions, velocities and accelerations.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "cablefit/samples/rows/butterworth.hpp"
#include "cablefit/samples/survey/windows.hpp"

namespace cablefit {

/// How signals are made from samples.
struct SignalSettings {
  double cutoff = 0;  ///< Hz; 0: no low-pass
  int filter_order = 4;
  bool torque_held = false;  ///< tau[i] acts from t[i] until t[i] + torque_period
  double torque_period = 0;  ///< s; 0: the log's period
  /// Motion so slow against the rate that only positions, velocities and torques matter: no
  /// accelerations, no filtered directions.
  bool quasi_static = false;
};

/// Signals of one joint over the rows of a window; an empty array where the log has no such
/// channel. Position-like signals are filtered; derivatives are five-point central differences of
/// fourth order. `tau` is filtered and moved by half the hold (tau(t - T/2)) when it is held.
struct JointSignals {
  Eigen::ArrayXd q, qd, qdd;  ///< rad, rad/s, rad/s^2
  Eigen::ArrayXd theta, thetad, thetadd;
  Eigen::ArrayXd tau, tau_load;  ///< N m
  /// sgn(qd), sgn(thetad) through the same low-pass as the signals: real friction flips at once,
  /// and the filter has smoothed that flip in every other term of the equation.
  Eigen::ArrayXd q_direction, theta_direction;
  Eigen::ArrayXd approach;  ///< -1, 0, 1: direction of the last motion of theta
};

struct Signals {
  Eigen::Index first = 0, begin = 0, end = 0;  ///< as in Window
  double t0 = 0, period = 0;
  std::vector<JointSignals> joints;
  double log_began = 0;  ///< s, in the time of t0
  Eigen::Index n_rows() const;
};

/// Rows a filtered window needs on either side.
Eigen::Index signal_halo(const SignalSettings& settings, double rate);
/// Longest hole of an uneven log that the filter bridges, s: a quarter period of the cut-off.
double bridge_seconds(const SignalSettings& settings);
/// First and last rows of a segment at which differences are not to be trusted.
inline constexpr Eigen::Index kDifferenceEdge = 3;

Signals make_signals(const Window& window, const LogPlan& plan, const SignalSettings& settings);

}  // namespace cablefit
