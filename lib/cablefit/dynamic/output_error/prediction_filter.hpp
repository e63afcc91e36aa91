// Residuals of a simulation that is driven by a measured, noisy torque. Torque noise makes
// simulated positions drift, and makes the simulated motion, on which the sensitivities depend, as
// noisy as the residual: plain output error then finds a wrong inertia, however long the log. So
// the noise of every row's forces is an unknown of its own: the fit minimises
//
//   sum (force noise / its sd)^2 + sum ((simulated - measured position) / its sd)^2
//
// over parameters, initial states and all force noises (total least squares in the time domain;
// Jazwinski 1970, 5.3, with Golub & Pereyra 1973 for the elimination). Given the parameters an
// extended Kalman filter and the Bryson-Frazier smoother find the noises; about the smoothed
// motion, which the torque noise has left, the model is linear, and a second filter eliminates
// states and noises from the rows of the parameters. Without force noise this is output error with
// free initial states.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "cablefit/dynamic/output_error/measured_stretch.hpp"
#include "cablefit/simulate/sensitivity/sensitive_plant.hpp"

namespace cablefit {

/// White noise per axis: of measured positions (rad), and of the forces, constant over a row (N m).
struct NoiseLevels {
  Eigen::VectorXd position, force;
};

/// How a window is stepped through and looked at.
struct FilterSettings {
  int steps = 4;  ///< per row, of the simulation that is held against the log
  /// Of the one that motions are smoothed with, and likelihoods and derivatives made of. Residuals
  /// are exact whatever motion they are linear about, as long as it is near.
  int smoothing_steps = 4;
  /// Every so many rows positions are compared. Where force noise moves an axis less than the
  /// position noise from row to row, the fastest differences say nothing of the parameters but
  /// depend on how well the position noise is known.
  std::size_t compare_every = 1;

  bool compares(std::size_t row) const { return row % compare_every == 0; }
};

/// The motion of a window that agrees best with positions and forces, row by row.
struct SmoothedMotion {
  bool valid = false;               ///< false: the simulation diverged
  Eigen::MatrixXd state;            ///< positions, then velocities; x rows
  Eigen::MatrixXd correction;       ///< of the forces, N m; axes x (rows - 1)
  double minus_log_likelihood = 0;  ///< -2 log likelihood of the measured positions, but a constant
};

/// `plant`: without parameters, with inputs. `smooth`: else only the likelihood.
SmoothedMotion smooth_motion(SensitivePlant& plant, const OutputErrorWindow& window,
                             const NoiseLevels& noise, const FilterSettings& settings,
                             bool smooth = true);

/// Whitened residuals and their derivatives by the plant's parameters, states and force noises
/// eliminated: n_axes rows per row of the window that is compared but the first; columns:
/// parameters, then the residual (simulated less measured). `plant`: with parameters and inputs.
/// Empty when the simulation diverged.
Eigen::MatrixXd window_residuals(SensitivePlant& plant, const OutputErrorWindow& window,
                                 const NoiseLevels& noise, const SmoothedMotion& motion,
                                 const FilterSettings& settings);

}  // namespace cablefit
