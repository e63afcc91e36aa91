// Influence of the error of searched l_o on the values. refine keeps l_o constant, so its fits do
// not include it. Internal to refine/.
#pragma once

#include "cablefit/refine/rows/final_fit.hpp"
#include "cablefit/refine/rows/shape_moves.hpp"
#include "cablefit/refine/steps/refine_bench.hpp"

namespace cablefit {

/// Widens the intervals by an error that stays in the values. It is one vector with one cause, so
/// the errors of the values are correlated.
void add_systematic(const ValueChange& error, FinalFit& fit);

/// Adds the error of l_o to the covariance of the fit. The values are fitted again, rows weighted
/// by 1/level^2, with l_o moved by each column of a root of its covariance (m^2 or rad^2). False:
/// one of these fits does not exist, and its part is missing.
bool add_elongation_errors(const Design& design, const Eigen::VectorXd& x, const KindLevels& levels,
                           const RefineBench& bench, FinalFit& fit);

}  // namespace cablefit
