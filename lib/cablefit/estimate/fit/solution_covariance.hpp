// The robust covariance of a solution. Internal to estimate/; others read LinearSolution.
#pragma once

#include "cablefit/estimate/fit/least_squares.hpp"

namespace cablefit {

/// Fills covariance, degrees_of_freedom and effective_rows: the sandwich (W'W)^-1 S (W'W)^-1 with S
/// the long-run covariance of the cells' scores W' rho. Needs x, n_rows, n_params,
/// residual_combination, solve_operator, score_columns and covariance_white.
void robust_covariance(const RowStatistics& rows, LinearSolution& solution);

/// With one parameter on its bound the others look better determined than they are: what they trade
/// with it is still unknown. Their variance becomes at least that of the fit without bounds.
void widen_beside_bounds(LinearSolution& solution);

}  // namespace cablefit
