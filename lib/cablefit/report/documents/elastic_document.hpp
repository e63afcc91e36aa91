// Stage 1 as a report: the paper's Table 1, errors, choices and warnings.
#pragma once

#include "cablefit/elastic/elastic_result.hpp"
#include "cablefit/report/parts/document.hpp"

namespace cablefit {

Document elastic_document(const ElasticResult& result);

/// Table 1: preloads as rows; linear stiffness with the deflection range it was fitted on (it
/// depends on it), then two coefficients of every cable. Further coefficients have a table with a
/// row each. Where the first table grows wider than a page, all coefficients have a row each, in as
/// many tables as it takes.
std::vector<Table> stiffness_tables(const ElasticResult& result);

}  // namespace cablefit
