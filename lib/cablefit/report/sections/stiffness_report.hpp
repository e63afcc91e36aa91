// Stiffness matrices and the nearest preload in equilibrium, as tables of `cablefit design`.
#pragma once

#include "cablefit/design/design_result.hpp"
#include "cablefit/report/parts/document.hpp"

namespace cablefit {

/// Matrices, cables, a log and the balance, those that the result has.
void add_stiffness(const DesignResult& result, Document& document);

}  // namespace cablefit
