// Do instruments explain data that neither fit has seen better than least squares does?
#pragma once

#include "cablefit/estimate/fit/least_squares.hpp"

namespace cablefit {

/// What residuals of held-out blocks still share with the instruments Z: r'Z (Z'Z)^-1 Z'r of each
/// of `n_blocks` stretches of the cells, r by a fit to the other stretches, summed. Regressors
/// without error leave both fits alike; where least squares is biased, `plain` is larger.
struct HeldOutMoments {
  double plain = 0;  ///< fitted by least squares
  double with = 0;   ///< fitted by the instruments
};
/// Bounds are left out. Zeros where there are fewer cells than blocks.
HeldOutMoments held_out_moments(const RowStatistics& rows, const LinearProblem& problem,
                                int n_blocks = 10);

}  // namespace cablefit
