// Filter, decimation and rest speeds where several joints need different ones.
#pragma once

#include <vector>

#include "cablefit/dynamic/rows/dynamic_job.hpp"

namespace cablefit {

/// Fills job.settings and, with several joints, job.joint_settings. Every equation keeps the
/// cut-off, the rest speed and the margin around rest of its joint; all share the finest decimation
/// and the widest edges. `resonances`: f0 of each joint, Hz, 0: unknown.
void choose_joint_settings(DynamicJob& job, const SampleOptions& options,
                           const std::vector<double>& resonances);

}  // namespace cablefit
