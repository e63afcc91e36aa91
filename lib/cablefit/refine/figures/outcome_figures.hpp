// Plots of the outcome of a refinement: candidates, and changes of the parameters. Internal to
// refine/.
#pragma once

#include <vector>

#include "cablefit/refine/refine_result.hpp"

namespace cablefit {

inline constexpr int kBefore = 1, kAfter = 2;  ///< series, the same colours everywhere

/// Only figures with content.
std::vector<Figure> outcome_figures(const RefineResult& result);

}  // namespace cablefit
