// Effects one by one: searched for, judged by held-out blocks of the training logs, added. Test
// logs are read later, see test_reading.hpp. Internal to refine/.
#pragma once

#include "cablefit/refine/steps/refine_bench.hpp"

namespace cablefit {

/// One round: search, judge, add. False: nothing was added.
bool add_next_effect(RefineBench& bench, Chain& chain, RefineResult& result);

/// Of two effects. The first was named while the second was missing: named again beside it, it may
/// be another.
void name_first_again(RefineBench& bench, Chain& chain, RefineResult& result);

/// Two effects together may look like a third, and what is best alone is then neither. Where one or
/// two leave something, other beginnings are tried: each with what is best beside it, and named
/// again beside that.
void begin_otherwise(RefineBench& bench, Chain& chain, RefineResult& result);

}  // namespace cablefit
