// The nonlinear parameters of what was named, moved to where all values fit together: a search
// found them with coefficients of a model without the effect. Internal to refine/.
#pragma once

#include "cablefit/refine/steps/refine_bench.hpp"

namespace cablefit {

/// The state with the free shapes of its effects where its training rows fit best (Gauss & Newton,
/// steps that do not fit better are not taken).
RefineState with_best_shapes(const RefineBench& bench, RefineState state);

}  // namespace cablefit
