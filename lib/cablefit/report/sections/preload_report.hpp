// The trade-off between preloads as a table and a picture. Internal to report/.
#pragma once

#include "cablefit/campaign/preload_advice.hpp"
#include "cablefit/report/parts/document.hpp"

namespace cablefit {

/// Adds both to the document of a campaign; nothing without two cells to compare.
void add_preload_advice(const BatchResult& result, Document& document);

}  // namespace cablefit
