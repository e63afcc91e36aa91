// Effects that the logs do not separate from the identified one, even where the blocks prefer one.
// Internal to refine/.
#pragma once

#include "cablefit/refine/refine_result.hpp"

namespace cablefit {

/// Adds to the rivals of the first effect those that explain nearly as much and are in one of its
/// groups in `not_separable`. The difference between their fits is then smaller than the errors
/// from rounding and filters. Of an effect that is nearly in the model, all that explain nearly as
/// much: what is left of it is similar to what is left of others.
void add_inseparable_rivals(RefineResult& result);

}  // namespace cablefit
