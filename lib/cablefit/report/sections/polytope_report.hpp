// Torques that the cables can make, as tables and a plot. Internal to report/.
#pragma once

#include "cablefit/design/design_result.hpp"
#include "cablefit/report/parts/document.hpp"

namespace cablefit {

/// Nothing where they were not asked for.
void add_polytopes(const DesignResult& result, Document& document);

}  // namespace cablefit
