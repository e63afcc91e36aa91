// Effects that the logs cannot tell from the one that was named, whatever the blocks prefer.
// Internal to refine/.
#pragma once

#include "cablefit/refine/refine_result.hpp"

namespace cablefit {

/// Adds to the rivals of the first effect those of its groups in `not_separable` that explain
/// nearly as much: what distinguishes their fits is less than rounding and filters change.
void add_inseparable_rivals(RefineResult& result);

}  // namespace cablefit
