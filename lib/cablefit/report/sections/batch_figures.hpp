// What a campaign shows at a glance: every parameter against the preload and against the date, with
// its interval.
#pragma once

#include <vector>

#include "cablefit/campaign/batch.hpp"
#include "cablefit/figure/figure.hpp"

namespace cablefit {

/// Titles of the axes that have names along them: a preload's, or dates (ISO 8601), which are drawn
/// as far from each other as they are.
inline constexpr const char* kPreloadAxis = "preload";
inline constexpr const char* kDateAxis = "date";

/// One figure per parameter, against the preload where there are several, against the date where
/// there are several; one trace per model and robot, and against the date per preload.
std::vector<Figure> parameter_figures(const BatchResult& result);

}  // namespace cablefit
