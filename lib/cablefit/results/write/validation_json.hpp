// How a fit does on logs, as JSON. Internal to results/.
#pragma once

#include "cablefit/dynamic/validation_result.hpp"
#include "cablefit/results/write/json_parts.hpp"

namespace cablefit::result_json {

/// Residual tests on the logs that were fitted.
Json residual_tests(const std::vector<JudgedEquation>& equations);
Json validation(const Validation& validation);

}  // namespace cablefit::result_json
