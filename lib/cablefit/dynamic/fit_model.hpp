// Converts a fit of stage 2 to a model.
#pragma once

#include "cablefit/dynamic/dynamic_result.hpp"
#include "cablefit/model/model.hpp"

namespace cablefit {

/// Its effects, the cables of stage 1 and the joint covariance. Parameters that the data do not
/// determine stay as in the fit, NaN or at a bound. Without stage 1 the model is rigid.
Model model_of(const DynamicFit& fit, const DynamicPreload& preload, const Rig& rig);

}  // namespace cablefit
