// The result of the one-step identification as a document.
#pragma once

#include "cablefit/identify/identify_result.hpp"
#include "cablefit/report/parts/document.hpp"

namespace cablefit {

Document identify_document(const IdentifyResult& result);

}  // namespace cablefit
