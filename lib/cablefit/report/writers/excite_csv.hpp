// The run that `refine` recommends, as a reference for a controller.
#pragma once

#include <string>

#include "cablefit/refine/refine_result.hpp"

namespace cablefit {

/// "t,theta_ref,tau_load" in SI, one row per sample; of a run with the link held a comment says so.
std::string excite_csv(const NextRun& run);

}  // namespace cablefit
