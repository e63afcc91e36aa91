// Effects that the logs do not separate from the identified one, even where the blocks prefer one.
// Internal to refine/.
#pragma once

#include "cablefit/refine/refine_result.hpp"

namespace cablefit {

/// Adds to the rivals of the first effect those of its groups in `not_separable` that explain
/// nearly as much. The difference between their fits is then smaller than the errors from rounding
/// and filters.
void add_inseparable_rivals(RefineResult& result);

}  // namespace cablefit
