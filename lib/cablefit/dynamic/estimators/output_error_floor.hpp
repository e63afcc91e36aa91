// Bias of output error where friction is nonlinear within the noise of the velocity: its filter
// linearises the model about the motion (prediction_filter.hpp). No residual shows it.
#pragma once

#include <map>
#include <string>

#include "cablefit/dynamic/output_error/output_error.hpp"
#include "cablefit/dynamic/rows/dynamic_job.hpp"

namespace cablefit::estimation {

struct OutputErrorFloor {
  std::map<std::string, double> sd;  ///< by parameter, in its unit; empty: not measured
  std::string note;                  ///< how it was measured, or why it was not
};

/// Simulates the measured motion with the fitted model, with white torque noise of the motors at
/// the fitted level and with the encoders' steps, and fits a pair of such copies (CopyDraws). The
/// mean error is the bias. `options`: of the fit.
OutputErrorFloor output_error_floor(const DynamicJob& job, const OutputErrorFit& fit,
                                    OutputErrorOptions options);

}  // namespace cablefit::estimation
