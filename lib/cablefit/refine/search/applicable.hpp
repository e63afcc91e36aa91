// Which rows of the catalogue apply to these logs. Internal to refine/.
#pragma once

#include "cablefit/refine/rows/design.hpp"

namespace cablefit {

/// Whether a row of the catalogue may be identified from these rows: any row with moving logs,
/// otherwise only those that blocked logs can separate.
bool is_candidate(const Effect& effect, const Design& design);

}  // namespace cablefit
