// Residuals of a simulation that is driven by a measured, noisy torque. Torque noise makes
// simulated positions drift. It also makes the simulated motion, which the sensitivities depend on,
// as noisy as the residual. Plain output error then finds a wrong inertia for logs of any length.
// So the noise of every row's forces is an unknown of its own. The fit minimises
//
//   sum (force noise / its sd)^2 + sum ((simulated - measured position) / its sd)^2
//
// over parameters, initial states and all force noises (total least squares in the time domain;
// Jazwinski 1970, 5.3, with Golub & Pereyra 1973 for the elimination). For given parameters an
// extended Kalman filter and the Bryson-Frazier smoother find the noises. The smoothed motion is
// free of torque noise, and about it the model is linear. A second filter eliminates states and
// noises from the rows of the parameters. Without force noise this is output error with free
// initial states.
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

/// How a window is simulated and compared.
struct FilterSettings {
  int steps = 4;  ///< per row, of the simulation that is compared with the log
  /// Steps per row of the simulation for smoothing, likelihoods and derivatives. Residuals are
  /// exact for any nearby motion that they are linearised about.
  int smoothing_steps = 4;
  /// Positions are compared in every n-th row. Where force noise moves an axis less than the
  /// position noise from row to row, the fastest differences contain no information on the
  /// parameters, but depend on how well the position noise is known.
  std::size_t compare_every = 1;

  bool compares(std::size_t row) const { return row % compare_every == 0; }
};

/// The motion of a window that agrees best with positions and forces, row by row.
struct SmoothedMotion {
  bool valid = false;               ///< false: the simulation diverged
  Eigen::MatrixXd state;            ///< positions, then velocities; x rows
  Eigen::MatrixXd correction;       ///< of the forces, N m; axes x (rows - 1)
  double minus_log_likelihood = 0;  ///< -2 log likelihood of the positions, without a constant
};

/// `plant`: without parameters, with inputs. `smooth`: false gives the likelihood only.
SmoothedMotion smooth_motion(SensitivePlant& plant, const OutputErrorWindow& window,
                             const NoiseLevels& noise, const FilterSettings& settings,
                             bool smooth = true);

/// Whitened residuals and their derivatives by the plant's parameters, with states and force noises
/// eliminated: n_axes rows per compared row of the window except the first. Columns: parameters,
/// then the residual (simulated less measured). `plant`: with parameters and inputs. Empty when the
/// simulation diverged.
Eigen::MatrixXd window_residuals(SensitivePlant& plant, const OutputErrorWindow& window,
                                 const NoiseLevels& noise, const SmoothedMotion& motion,
                                 const FilterSettings& settings);

}  // namespace cablefit
