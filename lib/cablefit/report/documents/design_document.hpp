// A sweep of the preload as tables: closure, stiffness, tensions, friction, and what simpler models
// cost.
#pragma once

#include "cablefit/design/design_result.hpp"
#include "cablefit/report/parts/document.hpp"

namespace cablefit {

Document design_document(const DesignResult& result);

}  // namespace cablefit
