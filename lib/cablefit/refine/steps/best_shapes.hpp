// Fits the nonlinear parameters of identified effects together with all other values: a search
// found them with coefficients of a model without the effect. Internal to refine/.
#pragma once

#include "cablefit/refine/steps/refine_bench.hpp"

namespace cablefit {

/// The state with the free shapes of its effects that fit its training rows best (Gauss-Newton;
/// steps that do not improve the fit are not taken).
RefineState with_best_shapes(const RefineBench& bench, RefineState state);

}  // namespace cablefit
