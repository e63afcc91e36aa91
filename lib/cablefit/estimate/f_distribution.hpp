// Tail of Fisher's F distribution, for tests of several restrictions at once.
#pragma once

namespace cablefit {

/// Probability that F with these degrees of freedom (> 0, not necessarily whole) exceeds
/// `statistic` >= 0: the regularised incomplete beta function by Lentz' continued fraction
/// (Abramowitz & Stegun 26.6.2 and 26.5.8; Press et al. 2007, 6.4). Relative error below 1e-9.
double f_upper_tail(double statistic, double dof_numerator, double dof_denominator);

}  // namespace cablefit
