// Effects one by one: searched for, judged, added on trial, confirmed. Internal to refine/.
#pragma once

#include "cablefit/refine/refine_bench.hpp"

namespace cablefit {

/// One round: search, judge, confirm, add. False: nothing was added.
bool add_next_effect(RefineBench& bench, RefineState& state, RefineResult& result);

/// Of two effects. The first was named while the second was missing: named again beside it, it may
/// be another. `first`: the state before any was added.
void name_first_again(RefineBench& bench, const RefineState& first, RefineState& state,
                      RefineResult& result);

/// Two effects together may look like a third, and what is best alone is then neither. Where one or
/// two leave something, other beginnings are tried: each with what is best beside it, and named
/// again beside that.
void begin_otherwise(RefineBench& bench, const RefineState& first, RefineState& state,
                     RefineResult& result);

}  // namespace cablefit
