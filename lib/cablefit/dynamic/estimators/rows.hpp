// The rows of the table of estimators, and what several of them are made of. Internal to dynamic/.
#pragma once

#include "cablefit/dynamic/estimators.hpp"

namespace cablefit::estimation {

Estimator ols();
Estimator wls();
Estimator iv();
Estimator automatic();

/// What row `wls` does.
Estimation weighted_least_squares(const EstimationTask& task);

}  // namespace cablefit::estimation
