// Error of output error itself where friction bends within the noise of the velocity: its filter is
// linear in the state (prediction_filter.hpp). No residual shows it.
#pragma once

#include <map>
#include <span>
#include <string>

#include "cablefit/dynamic/output_error/output_error.hpp"
#include "cablefit/dynamic/rows/dynamic_job.hpp"

namespace cablefit::estimation {

struct OutputErrorFloor {
  std::map<std::string, double> sd;  ///< by parameter, in its unit; empty: not measured
  std::string note;                  ///< how it was measured, or why it was not
};

/// Simulates the measured motion with the fitted model, with the noise levels that the fit found,
/// and fits kFloorDraws such copies. The mean error is the bias of the method, and what is left of
/// the noise. `options`: of the fit.
OutputErrorFloor output_error_floor(const DynamicJob& job, const OutputErrorFit& fit,
                                    OutputErrorOptions options);

}  // namespace cablefit::estimation
