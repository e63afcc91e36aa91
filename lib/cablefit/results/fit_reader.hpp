// One fit of a stage-1 result file. Internal to results/.
#pragma once

#include <string_view>

#include "cablefit/base/json/json_document.hpp"
#include "cablefit/elastic/elastic_result.hpp"
#include "cablefit/model/rig.hpp"

namespace cablefit {

/// Rebuilds the curve on the rig's cables, or the linear spring, from the named coefficients.
ElasticFit read_elastic_fit(const JsonNode& node, const Rig& rig);

/// NaN for null and for a missing key.
double number_or_nan(const JsonNode& object, std::string_view key);

}  // namespace cablefit
