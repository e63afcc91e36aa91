// Computes smooth positions, velocities and accelerations from a window of raw samples.
#pragma once

#include <Eigen/Core>
#include <optional>
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
  /// The motion is so slow relative to the rate that only positions, velocities and torques matter.
  /// Accelerations and filtered directions are not computed.
  bool quasi_static = false;
};

/// Signals of one joint over the rows of a window; empty arrays for channels that the log lacks.
/// Position-like signals are filtered. Derivatives are five-point central differences of fourth
/// order. `tau` is filtered, and when it is held, shifted by half the hold (tau(t - T/2)).
struct JointSignals {
  Eigen::ArrayXd q, qd, qdd;  ///< rad, rad/s, rad/s^2
  Eigen::ArrayXd theta, thetad, thetadd;
  Eigen::ArrayXd tau, tau_load;  ///< N m
  /// sgn(qd), sgn(thetad) through the same low-pass as the signals. Real friction reverses at once,
  /// and the filter smooths that step in every other term of the equation.
  Eigen::ArrayXd q_direction, theta_direction;
  Eigen::ArrayXd approach;  ///< -1, 0, 1: direction of the last motion of theta
};

/// The low-pass that made the signals of a window.
struct SignalFilter {
  std::optional<Butterworth> low_pass;  ///< none: no cut-off
  bool starts_segment = false, ends_segment = false;

  /// Filters every column in place. What is made of filtered signals and jumps is filtered again,
  /// as the torque has been.
  void apply(Eigen::Ref<Eigen::MatrixXd> columns) const;
};

struct Signals {
  Eigen::Index first = 0, begin = 0, end = 0;  ///< as in Window
  double t0 = 0, period = 0;
  std::vector<JointSignals> joints;
  double log_began = 0;  ///< s, in the time of t0
  SignalFilter filter = {};
  Eigen::Index n_rows() const;
};

/// Rows that a filtered window needs on either side.
Eigen::Index signal_halo(const SignalSettings& settings, double rate);
/// Longest hole of an uneven log that is interpolated, s: a quarter period of the cut-off.
double bridge_seconds(const SignalSettings& settings);
/// Number of first and last rows of a segment whose differences are not valid.
inline constexpr Eigen::Index kDifferenceEdge = 3;

Signals make_signals(const Window& window, const LogPlan& plan, const SignalSettings& settings);

}  // namespace cablefit
