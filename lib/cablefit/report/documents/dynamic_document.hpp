// Stage 2 as a report: the paper's Table 2, torque errors, choices and warnings.
#pragma once

#include <vector>

#include "cablefit/dynamic/dynamic_result.hpp"
#include "cablefit/report/parts/document.hpp"

namespace cablefit {

Document dynamic_document(const DynamicResult& result);

/// Table 2: parameters as rows with the paper's symbol, unit and CAD value; per preload and model
/// the value and its relative standard deviation. As many tables as it takes to stay readable in
/// width.
std::vector<Table> parameter_tables(const DynamicResult& result);

}  // namespace cablefit
