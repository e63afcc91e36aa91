// Effects one by one: search, judgement by held-out blocks of the training logs, addition. Test
// logs are read later, see test_reading.hpp. Internal to refine/.
#pragma once

#include "cablefit/refine/steps/refine_bench.hpp"

namespace cablefit {

/// One round: search, judge, add. False: no effect was added.
bool add_next_effect(RefineBench& bench, Chain& chain, RefineResult& result);

/// With two effects, identifies the first again: it was identified without the second, and beside
/// the second another effect may fit better.
void name_first_again(RefineBench& bench, Chain& chain, RefineResult& result);

/// Tries other first effects where one or two effects leave a residual. Two effects together may
/// look like a third one, which is then the best single effect although it is wrong. Each other
/// first effect gets the best second one, and is then identified again beside that.
void begin_otherwise(RefineBench& bench, Chain& chain, RefineResult& result);

}  // namespace cablefit
