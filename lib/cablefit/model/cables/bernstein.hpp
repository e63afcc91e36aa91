// Polynomials in Bernstein form: one lies within the range of its coefficients, so that
// coefficients that are not negative make it so. Internal to the cable laws.
#pragma once

#include <Eigen/Core>

namespace cablefit {

/// Row i, times c, is Bernstein coefficient i on [from, to] of sum_j c_j l^j, j = 0 .. degree
/// (Farin 2002, ch. 3-5: its blossom with i arguments `to` and the others `from`). 0 <= from <= to;
/// then no entry is negative. The first and last row are the values at the ends. (degree+1) x
/// (degree+1).
Eigen::MatrixXd bernstein_rows(int degree, double from, double to);

}  // namespace cablefit
