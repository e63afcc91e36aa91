// Does the estimate depend on settings that should not matter? The same fit with other cut-offs and
// rest speeds. Internal to dynamic/.
#pragma once

#include "cablefit/dynamic/estimators/estimators.hpp"

namespace cablefit {

/// Fits model `model` again with the cut-off times 0.5 .. 2 (decimation and edges follow it), and
/// separately with the rest speed times 0.5 .. 2, and compares with `fit`. A setting is flat when
/// no parameter changes by more than 2 sd and 1 % over its range. Cut-offs that the rate does not
/// allow are left out.
Sweep sweep_settings(const DynamicJob& job, const Estimator& estimator, std::size_t model,
                     const DynamicFit& fit);

}  // namespace cablefit
