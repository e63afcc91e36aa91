// Which rows of the catalogue make sense for these logs. Internal to refine/.
#pragma once

#include "cablefit/refine/rows/design.hpp"

namespace cablefit {

/// Whether a row of the catalogue may be named from these rows: any with moving logs, else those
/// that a blocked link can separate.
bool is_candidate(const Effect& effect, const Design& design);

}  // namespace cablefit
