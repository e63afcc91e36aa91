// Evenly spaced rows of a log for output error, cut into windows.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "cablefit/model/model.hpp"

namespace cablefit {

/// Gapless rows, rows x joints, SI. Signals that the model does not need may be empty.
struct MeasuredStretch {
  double period = 0;              ///< s
  double t0 = 0;                  ///< s since the log began, of the first row
  bool hold_torque = true;        ///< tau held over a row (zoh), else linear between rows
  Eigen::ArrayXXd q, theta;       ///< rad
  Eigen::ArrayXXd tau, tau_load;  ///< N m; tau_load: 0 when empty
  Eigen::ArrayXXd theta_ref;      ///< rad; closed loop only
};

/// One window: positions and forces of every axis (links, then motors; rigid drives: one each), and
/// the start of the simulation. Row r of axis a is at [r * n_axes + a].
struct OutputErrorWindow {
  double period = 0, t0 = 0;
  bool hold_torque = true;
  std::size_t n_rows = 0, n_axes = 0;
  std::size_t first_number = 0;        ///< of its first row, over all windows
  std::vector<double> position;        ///< measured, rad
  std::vector<double> held, sloping;   ///< forces constant over a row, and linear between rows, N m
  std::vector<double> start_velocity;  ///< rad/s, per axis
};

/// Windows of about `seconds`. None is shorter than half of it, unless its stretch is. Stretches of
/// fewer than 16 rows are left out. `position_sd`: noise of the positions, per axis, rad.
std::vector<OutputErrorWindow> cut_windows(const Model& model,
                                           const std::vector<MeasuredStretch>& stretches,
                                           double seconds, const Eigen::VectorXd& position_sd);

}  // namespace cablefit
