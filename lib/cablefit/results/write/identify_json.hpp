// The result of the one-step identification as JSON: cablefit/identify/1, data/schema/.
#pragma once

#include <string>

#include "cablefit/identify/identify_result.hpp"

namespace cablefit {

std::string identify_json(const IdentifyResult& result);

}  // namespace cablefit
