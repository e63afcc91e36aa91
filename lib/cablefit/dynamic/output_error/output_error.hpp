// Output error: the parameters with which the simulation follows the measured positions best, with
// the noise of the torque that drives it taken for what it is (prediction_filter.hpp).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cablefit/base/parameter.hpp"
#include "cablefit/dynamic/output_error/measured_stretch.hpp"
#include "cablefit/dynamic/output_error/prediction_filter.hpp"

namespace cablefit {

/// What an earlier stage knows of some parameters: rows of the fit.
struct GaussianPrior {
  std::vector<std::string> names;
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;  ///< robust
};

/// The logs once more, and the same rows with the positions that a noise-free loop makes in place
/// of the measured ones.
struct NoiseFreeLogs {
  std::vector<MeasuredStretch> measured, noise_free;
  std::string failure;  ///< why there are none; empty: there are
};

struct OutputErrorOptions {
  std::vector<std::string> held;  ///< parameters to leave as they are
  GaussianPrior prior;
  Eigen::VectorXd position_sd;  ///< rad, per axis (links, then motors; rigid drives one each)
  /// N m, per axis, of the forces; empty: estimated. 0 where there is none.
  Eigen::VectorXd force_sd;
  double window = 2;  ///< s
  /// s, upper limit; divided so that a row is a whole number of steps. Twice as long ones leave
  /// J_motor of the paper's rig 0.12 % too high, which 30 s of its logs show.
  double step = 125e-6;
  double first_step = 500e-6;  ///< until the fit has settled, and to smooth motions
  /// Rows, see FilterSettings: until the fit has settled, and at last.
  int first_compare_every = 5, compare_every = 2;
  /// Rows looked at until the fit has settled, in windows spread over the logs; at last all are.
  double first_rows = 16000;
  int max_rounds = 3;       ///< of noise and fit until it has settled
  int max_iterations = 10;  ///< of the fit in a round
  int threads = 1;
  /// The noise-free loop of a model: instruments against disturbances that come back through the
  /// controller (instrumental_fit.hpp). Empty: none is known.
  std::function<NoiseFreeLogs(const Model&)> noise_free_loop;
};

struct OutputErrorFit {
  Model model;  ///< with the fitted parameters and their sd
  std::vector<Estimate> parameters;
  Eigen::MatrixXd covariance, covariance_white;  ///< of `parameters`; 0 for those on a bound
  NoiseLevels noise;
  double residual_rms = 0;  ///< whitened: 1 when the noise levels are right
  double correlation = 0;   ///< of whitened residuals one row apart: 0 when they are right
  double degrees_of_freedom = 0, effective_rows = 0;
  std::size_t n_rows = 0;  ///< of the fit: rows of the log times axes
  bool converged = false;
  int n_rounds = 0;
  int n_passes = 0;  ///< over all rows, with sensitivities
  std::string message;
  std::string instruments;    ///< what became of them, in words; empty: there are none
  bool instrumented = false;  ///< parameters and covariances are those with instruments
  std::vector<std::string> warnings;
};

/// Starts from the parameters of `model`; the result does not depend on `threads`. Not to converge
/// is a result. Throws Error(usage) for a model with effects that are no torques of the motion
/// alone: errors of sensors and of the drive, events.
OutputErrorFit fit_output_error(const Model& model, const std::vector<MeasuredStretch>& stretches,
                                const OutputErrorOptions& options);

}  // namespace cablefit
