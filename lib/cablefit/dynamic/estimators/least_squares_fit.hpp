// Weighted least squares on given rows, which other estimators build on. Internal to dynamic/.
#pragma once

#include "cablefit/dynamic/estimators/estimators.hpp"

namespace cablefit::estimation {

/// Each equation alone, or the links of an arm, which share parameters, stacked.
Estimation least_squares_fit(const EstimationTask& task, Weighting weighting);

/// Which sd the parameters of these rows have, and why (see sd_reason).
std::string reason_for_sd(const EstimationTask& task, const RowStatistics& rows,
                          const DynamicColumns& columns, const LinearSolution& solution);

}  // namespace cablefit::estimation
