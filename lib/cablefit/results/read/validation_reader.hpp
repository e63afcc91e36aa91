// Tests of a fit on logs, out of a result file. Internal to results/.
#pragma once

#include "cablefit/base/json/json_document.hpp"
#include "cablefit/dynamic/validation_result.hpp"

namespace cablefit::result_file {

/// "residual_tests" of a preload; empty where it has none.
std::vector<JudgedEquation> read_residual_tests(const JsonNode& preload);
/// "validation" of a preload.
Validation read_validation(const JsonNode& node);

}  // namespace cablefit::result_file
