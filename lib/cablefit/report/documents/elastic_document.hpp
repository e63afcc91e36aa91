// Stage 1 as a report: the paper's Table 1, errors, choices and warnings.
#pragma once

#include "cablefit/elastic/elastic_result.hpp"
#include "cablefit/report/documents/document.hpp"

namespace cablefit {

Document elastic_document(const ElasticResult& result);

/// Table 1 alone: linear stiffness with the deflection range it was fitted on (it depends on it),
/// and the coefficients of every cable. Preloads are rows; where that grows too wide, coefficients
/// are.
Table stiffness_table(const ElasticResult& result);
/// The same in as many tables as it takes to stay within the width of a page.
std::vector<Table> stiffness_tables(const ElasticResult& result);

}  // namespace cablefit
