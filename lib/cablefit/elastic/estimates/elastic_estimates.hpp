// From the solution of a candidate to the fit that reports show.
#pragma once

#include "cablefit/elastic/elastic_result.hpp"
#include "cablefit/elastic/models/candidates.hpp"

namespace cablefit {

/// Everything reports need, except the errors that take a second look at the rows.
ElasticFit make_fit(const ElasticJob& job, const ElasticCandidate& candidate,
                    const LinearSolution& solution, const BlockedRows& rows,
                    std::span<const Nuisance> nuisance);
/// The motor's static friction without a value, where the logs do not determine it. `joint`: from
/// 0.
Estimate missing_friction(const ElasticJob& job, int joint);

}  // namespace cablefit
