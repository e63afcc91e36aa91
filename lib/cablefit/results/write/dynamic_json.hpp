// cablefit/dynamic/1: the result of stage 2 as a file, see data/schema/dynamic.schema.json.
#pragma once

#include <string>

#include "cablefit/dynamic/dynamic_result.hpp"

namespace cablefit {

std::string dynamic_json(const DynamicResult& result);

}  // namespace cablefit
