// The same job with a setting that should not matter changed.
#pragma once

#include "cablefit/dynamic/rows/dynamic_job.hpp"

namespace cablefit {

/// Beyond this share of the sample rate a cut-off lets differences be off by percents.
inline constexpr double kMostShareOfRate = 0.3;

/// Cut-offs of all equations, with decimation, edges and margins that follow from them.
DynamicJob with_cutoff_scaled(const DynamicJob& job, double factor);
DynamicJob with_rest_speed_scaled(const DynamicJob& job, double factor);
DynamicJob with_rest_margin_scaled(const DynamicJob& job, double factor);

}  // namespace cablefit
