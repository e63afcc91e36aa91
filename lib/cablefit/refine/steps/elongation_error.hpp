// What the error of searched l_o does to the values. refine holds l_o constant, so its fits do not
// include it. Internal to refine/.
#pragma once

#include "cablefit/refine/rows/final_fit.hpp"
#include "cablefit/refine/rows/shape_moves.hpp"
#include "cablefit/refine/steps/refine_bench.hpp"

namespace cablefit {

/// An error that stays in the values widens their intervals. It is one vector, of one cause, so
/// that the values are off together.
void add_systematic(const ValueChange& error, FinalFit& fit);

/// Adds how the values of a design, fitted with 1/level^2, change with l_o one sd away along each
/// axis of their covariance. False: such a design has no fit, and what could be added was.
bool add_elongation_errors(const Design& design, const Eigen::VectorXd& x, const KindLevels& levels,
                           const RefineBench& bench, FinalFit& fit);

/// Takes effects away of which no coefficient is 2 sd with the error of l_o, and what was found
/// beside them: a slip between preloads corrects l_o of one of them that are a little wrong.
void require_more_than_elongations(const RefineBench& bench, Chain& chain, RefineResult& result);

}  // namespace cablefit
