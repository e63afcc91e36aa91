// A campaign: Tables 1 and 2 over all cells, what failed, gates, and what refine said.
#pragma once

#include "cablefit/campaign/batch.hpp"
#include "cablefit/report/parts/document.hpp"

namespace cablefit {

Document batch_document(const BatchResult& result);

}  // namespace cablefit
