// The rows of the table of estimators. Internal to dynamic/.
#pragma once

#include "cablefit/dynamic/estimators.hpp"

namespace cablefit::estimation {

Estimator ols();
Estimator wls();
Estimator robust();
Estimator recursive();

}  // namespace cablefit::estimation
