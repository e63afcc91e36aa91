// The curve that stage 1's fit leaves in its residual, where there is one: what stage 2 may be off
// by, which no covariance of coefficients says.
#pragma once

#include "cablefit/elastic/elastic_result.hpp"
#include "cablefit/elastic/models/candidates.hpp"

namespace cablefit {

/// Means of the residual over kMisfitBins ranges of the deflection, on the way up and on the way
/// down: half their sum is a curve, half their difference a loop beyond constant friction. Empty
/// where neither is seen (F-test at 0.1 % over stretches of time). `solution`: of the candidate on
/// one joint's rows.
ElasticMisfit find_misfit(const BlockedRows& rows, const ElasticCandidate& candidate,
                          const LinearSolution& solution);

inline constexpr std::size_t kMisfitBins = 12;

}  // namespace cablefit
