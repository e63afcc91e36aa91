// Weighted least squares on given rows, which other estimators build on. Internal to dynamic/.
#pragma once

#include "cablefit/dynamic/estimators.hpp"

namespace cablefit::estimation {

/// Each equation alone, or the links of an arm, which share parameters, stacked.
Estimation least_squares_fit(const EstimationTask& task, Weighting weighting);

}  // namespace cablefit::estimation
