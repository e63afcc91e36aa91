// Estimates that are updated with every row, beside the direct answer from all rows: recursive
// least squares with a forgetting factor, and the gradient. Internal to dynamic/.
#pragma once

#include "cablefit/dynamic/estimators/estimators.hpp"

namespace cablefit::estimation {

enum class OnlineMethod { recursive, gradient };

/// The weighted fit to all rows, with a trace for each method; the parameters are those of that
/// fit. Throws Error(usage) where DynamicOptions::memory is too short for the number of parameters.
Estimation with_traces(const EstimationTask& task, std::span<const OnlineMethod> methods);

}  // namespace cablefit::estimation
