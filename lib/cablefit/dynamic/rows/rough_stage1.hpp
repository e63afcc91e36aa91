// An approximate elastic torque without stage 1. It is sufficient for the resonance, the filter and
// the size of the noise.
#pragma once

#include "cablefit/dynamic/rows/dynamic_job.hpp"

namespace cablefit {

/// Fits the coefficients of the rig's cables together with all effects of the motors to the first
/// windows of the job's moving logs: one preload with one "poly" fit. It changes job.elastic and
/// job.settings, which are not valid afterwards. Throws Error(not_identifiable) when the motors
/// hardly move.
ElasticResult rough_stage1(DynamicJob& job);

}  // namespace cablefit
