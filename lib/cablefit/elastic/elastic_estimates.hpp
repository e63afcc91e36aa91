// From the solution of a candidate to the fit that reports show.
#pragma once

#include "cablefit/elastic/candidates.hpp"
#include "cablefit/elastic/elastic_result.hpp"

namespace cablefit {

/// Everything reports need, except the errors that take a second look at the rows.
ElasticFit make_fit(const ElasticJob& job, const Candidate& candidate,
                    const LinearSolution& solution, const BlockedRows& rows,
                    const Nuisance& nuisance);

}  // namespace cablefit
