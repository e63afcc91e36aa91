// cablefit/check/1, see data/schema/check.schema.json.
#pragma once

#include <string>

#include "cablefit/dynamic/prediction.hpp"
#include "cablefit/samples/check.hpp"

namespace cablefit {

std::string check_json(const CheckResult& result, const std::vector<Prediction>& predictions = {});

}  // namespace cablefit
