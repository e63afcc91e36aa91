// A fit of stage 2 as a model that can be simulated. Internal to prove/.
#pragma once

#include <string>

#include "cablefit/dynamic/dynamic_result.hpp"
#include "cablefit/model/model.hpp"

namespace cablefit {

/// `why_not`: what keeps the fit from being simulated; empty when nothing does. Parameters that the
/// data cannot determine are an obstacle when they are inertias, else 0.
Model model_to_simulate(const DynamicFit& fit, const DynamicPreload& preload, const Rig& rig,
                        std::string& why_not);

}  // namespace cablefit
