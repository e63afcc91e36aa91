// A fit of stage 2 as a model.
#pragma once

#include "cablefit/dynamic/dynamic_result.hpp"
#include "cablefit/model/model.hpp"

namespace cablefit {

/// Its effects, the cables of stage 1 and the joint covariance. What the data do not determine is
/// as the fit has it, NaN or at its bound. Rigid without stage 1.
Model model_of(const DynamicFit& fit, const DynamicPreload& preload, const Rig& rig);

}  // namespace cablefit
