// The rows of logs for output error: unfiltered, on an even grid, one stretch between two gaps.
#pragma once

#include <span>
#include <vector>

#include "cablefit/dynamic/output_error/measured_stretch.hpp"
#include "cablefit/dynamic/rows/dynamic_job.hpp"

namespace cablefit {

/// Gapless rows of the wanted parts of `logs`, in their order, as measured: no filter, no
/// decimation. The job's settings decide whether the torque is held between rows. Every wanted part
/// must have theta, and q unless the drive is rigid. `simulated`: positions of the simulated loop
/// in place of the measured ones, for logs that contain them (LogCopy).
std::vector<MeasuredStretch> measured_stretches(const DynamicJob& job,
                                                std::span<const LogSurvey> logs,
                                                bool simulated = false);

/// sd of the white noise on every axis' position (position_noise(), the largest of all wanted
/// parts): links, then motors; for rigid drives one each. rad, > 0.
Eigen::VectorXd position_noise_of(const DynamicJob& job);

}  // namespace cablefit
