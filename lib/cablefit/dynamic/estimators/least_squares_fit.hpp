// Weighted least squares on given rows; other estimators start from it. Internal to dynamic/.
#pragma once

#include "cablefit/dynamic/estimators/estimators.hpp"

namespace cablefit::estimation {

/// Fits each equation alone. The links of an arm share parameters and are stacked.
Estimation least_squares_fit(const EstimationTask& task, Weighting weighting);

/// The kind of sd of these parameters, and the reason (see sd_reason).
std::string reason_for_sd(const EstimationTask& task, const RowStatistics& rows,
                          const DynamicColumns& columns, const LinearSolution& solution);

}  // namespace cablefit::estimation
