// The rows of the table of estimators. Internal to dynamic/.
#pragma once

#include "cablefit/dynamic/estimators/estimators.hpp"

namespace cablefit::estimation {

Estimator ols();
Estimator wls();
Estimator robust();
Estimator recursive();
Estimator gradient();
Estimator iv();
Estimator output_error();
Estimator automatic();

}  // namespace cablefit::estimation
