// The classical linear model scored as the paper does (Fichera & Grossard 2017, Figs. 6b and 7b): a
// given K, or the fit of a stated range of deflections, over all rows of these logs or of others.
#pragma once

#include <span>
#include <vector>

#include "cablefit/elastic/models/candidates.hpp"
#include "cablefit/elastic/rows/blocked_rows.hpp"

namespace cablefit {

/// Scores of the preload's fits and of the lines that the options name; none where they name none.
/// The torque is elastic: less the friction of the cables' fit, `cables` and its `solution`. One
/// joint. Throws Error(input) when a range holds no rows, or no test log is of this preload.
std::vector<ElasticScore> score_curves(const ElasticJob& job, const BlockedRows& rows,
                                       const ElasticPreload& preload,
                                       const ElasticCandidate& cables,
                                       const LinearSolution& solution);

}  // namespace cablefit
