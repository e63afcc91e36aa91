// Effects that the logs do not separate from the identified one, whatever the blocks prefer.
// Internal to refine/.
#pragma once

#include "cablefit/refine/refine_result.hpp"

namespace cablefit {

/// Adds to the rivals of the first effect those of its groups in `not_separable` that explain
/// nearly as much: what distinguishes their fits is less than rounding and filters change.
void add_inseparable_rivals(RefineResult& result);

}  // namespace cablefit
