// What a refinement decided, as plots: candidates, and how far the parameters moved. Internal to
// refine/.
#pragma once

#include <vector>

#include "cablefit/refine/refine_result.hpp"

namespace cablefit {

inline constexpr int kBefore = 1, kAfter = 2;  ///< series, the same colours everywhere

/// Those with something to show.
std::vector<Figure> outcome_figures(const RefineResult& result);

}  // namespace cablefit
