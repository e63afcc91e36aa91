// A campaign as a report: both tables over all preloads, what failed, the gates.
#pragma once

#include "cablefit/campaign/batch.hpp"
#include "cablefit/report/document.hpp"

namespace cablefit {

Document batch_document(const BatchResult& result);

/// cablefit/batch/1: the elastic and dynamic results of every cell, and the gates.
std::string batch_json(const BatchResult& result);

}  // namespace cablefit
