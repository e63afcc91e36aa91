// Output error: the parameters whose simulation agrees best with the measured positions. The noise
// of the driving torque is part of the model (prediction_filter.hpp).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cablefit/base/parameter.hpp"
#include "cablefit/dynamic/output_error/measured_stretch.hpp"
#include "cablefit/dynamic/output_error/prediction_filter.hpp"

namespace cablefit {

/// Estimates of some parameters from an earlier stage, as rows of the fit.
struct GaussianPrior {
  std::vector<std::string> names;
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;  ///< robust
};

/// The logs, and the same rows with the positions of a noise-free loop in place of the measured
/// ones.
struct NoiseFreeLogs {
  std::vector<MeasuredStretch> measured, noise_free;
  std::string failure;  ///< why there are none; empty: there are some
};

struct OutputErrorOptions {
  std::vector<std::string> held;  ///< parameters that keep their values
  GaussianPrior prior;
  Eigen::VectorXd position_sd;  ///< rad, per axis (links, then motors; rigid drives one each)
  /// N m, per axis, of the forces; empty: estimated; 0: no noise.
  Eigen::VectorXd force_sd;
  double window = 2;  ///< s
  /// s, upper limit; reduced so that a row is a whole number of steps. With twice the step J_motor
  /// of the paper's rig is 0.12 % too high, which is significant with 30 s of its logs.
  double step = 125e-6;
  double first_step = 500e-6;  ///< until the fit has converged, and for smoothing motions
  /// Rows, see FilterSettings: until the fit has converged, and after that.
  int first_compare_every = 5, compare_every = 2;
  /// Number of rows used until the fit has converged, in windows spread over the logs; then all are
  /// used.
  double first_rows = 16000;
  int max_rounds = 3;       ///< of noise and fit, until convergence
  int max_iterations = 10;  ///< of the fit in one round
  int threads = 1;
  /// The noise-free loop of a model, which gives instruments against disturbances that return
  /// through the controller (instrumental_fit.hpp). Empty: none is known.
  std::function<NoiseFreeLogs(const Model&)> noise_free_loop;
};

struct OutputErrorFit {
  Model model;  ///< with the fitted parameters and their sd
  std::vector<Estimate> parameters;
  Eigen::MatrixXd covariance, covariance_white;  ///< of `parameters`; 0 for those at a bound
  NoiseLevels noise;
  double residual_rms = 0;  ///< whitened: 1 when the noise levels are right
  double correlation = 0;   ///< of whitened residuals one row apart: 0 when noise is right
  double degrees_of_freedom = 0, effective_rows = 0;
  std::size_t n_rows = 0;  ///< of the fit: rows of the log times axes
  bool converged = false;
  int n_rounds = 0;
  int n_passes = 0;  ///< over all rows, with sensitivities
  std::string message;
  std::string instruments;    ///< how the instruments were used, in words; empty: there are none
  bool instrumented = false;  ///< parameters and covariances are those with instruments
  std::vector<std::string> warnings;
};

/// Starts from the parameters of `model`. The result does not depend on `threads`. A fit that does
/// not converge is a result, not an error. Throws Error(usage) for a model with effects that are no
/// torques of the motion alone: errors of sensors and of the drive, events.
OutputErrorFit fit_output_error(const Model& model, const std::vector<MeasuredStretch>& stretches,
                                const OutputErrorOptions& options);

}  // namespace cablefit
