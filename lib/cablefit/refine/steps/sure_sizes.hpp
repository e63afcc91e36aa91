// Effects whose size is not significant are not identified. Internal to refine/.
#pragma once

#include "cablefit/refine/steps/refine_bench.hpp"

namespace cablefit {

/// Removes every effect without a coefficient of at least 2 sd (the sd with the error of l_o), and
/// the effects found after it. A small error in the l_o of one preload looks like a slip between
/// the preloads.
void require_sure_sizes(const RefineBench& bench, Chain& chain, RefineResult& result);

}  // namespace cablefit
