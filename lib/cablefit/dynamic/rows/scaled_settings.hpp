// The same job with one changed setting that should not matter.
#pragma once

#include "cablefit/dynamic/rows/dynamic_job.hpp"

namespace cablefit {

/// With a cut-off above this share of the sample rate, differences have errors of percents.
inline constexpr double kMostShareOfRate = 0.3;

/// Scales the cut-offs of all equations; decimation, edges and margins follow.
DynamicJob with_cutoff_scaled(const DynamicJob& job, double factor);
DynamicJob with_rest_speed_scaled(const DynamicJob& job, double factor);
DynamicJob with_rest_margin_scaled(const DynamicJob& job, double factor);

}  // namespace cablefit
