// Estimates that every row updates, beside the direct fit to all rows: recursive least squares with
// a forgetting factor, and the gradient. Internal to dynamic/.
#pragma once

#include "cablefit/dynamic/estimators/estimators.hpp"

namespace cablefit::estimation {

enum class OnlineMethod { recursive, gradient };

/// The weighted fit to all rows, whose parameters are reported, with a trace for each method.
/// Throws Error(usage) where DynamicOptions::memory is too short for the number of parameters.
Estimation with_traces(const EstimationTask& task, std::span<const OnlineMethod> methods);

}  // namespace cablefit::estimation
