// The rows of logs as output error takes them: unfiltered, on an even grid, gap by gap.
#pragma once

#include <span>
#include <vector>

#include "cablefit/dynamic/output_error/measured_stretch.hpp"
#include "cablefit/dynamic/rows/dynamic_job.hpp"

namespace cablefit {

/// Gapless rows of the wanted parts of `logs`, in their order, as they were measured: no filter, no
/// decimation. The torque is held between rows or not as the job's settings say. Every wanted part
/// must have theta, and q unless the drive is rigid. `simulated`: the positions of a simulated loop
/// in place of the measured ones, of logs that carry them (LogCopy).
std::vector<MeasuredStretch> measured_stretches(const DynamicJob& job,
                                                std::span<const LogSurvey> logs,
                                                bool simulated = false);

/// sd of the white noise on every axis' position (position_noise(), the largest of all wanted
/// parts): links, then motors; of rigid drives one each. rad, > 0.
Eigen::VectorXd position_noise_of(const DynamicJob& job);

}  // namespace cablefit
