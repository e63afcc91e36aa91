// What a terminal shows without --verbose: the answer, in 40 lines for most results.
#pragma once

#include "cablefit/report/parts/document.hpp"

namespace cablefit {

/// Summary, first tables and warnings; without diagnostics, choices and what explains them, but for
/// files that were taken by themselves. Of many warnings the first ones, and how many more there
/// are.
Document on_screen(Document document);

}  // namespace cablefit
