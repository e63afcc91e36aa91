// A sweep of the preload as cablefit/design/1.
#pragma once

#include <string>

#include "cablefit/design/design_result.hpp"

namespace cablefit {

std::string design_json(const DesignResult& result);

}  // namespace cablefit
