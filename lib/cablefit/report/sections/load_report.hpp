// Links under a constant load as tables. Internal to report/.
#pragma once

#include "cablefit/design/design_result.hpp"
#include "cablefit/report/parts/document.hpp"

namespace cablefit {

/// Nothing where no load was asked for.
void add_held_loads(const DesignResult& result, Document& document);

}  // namespace cablefit
