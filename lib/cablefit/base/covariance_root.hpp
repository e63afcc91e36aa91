// A root of a covariance: draws of normal errors and principal axes come from it.
#pragma once

#include <Eigen/Core>

namespace cablefit {

/// r (p x p) with r r' = a, for a symmetric `a` (p x p) without negative eigenvalues, of any units.
/// `a` is first scaled to ones on its diagonal: variances in (N/m^3)^2 and (N m)^2 side by side
/// differ by 10^20, and small eigenvalues would be smaller than the rounding of the large ones.
/// The columns are eigenvectors of the scaled matrix in ascending order of its eigenvalues,
/// scaled back; 0 where the eigenvalue is rounding (below 1e-12).
Eigen::MatrixXd covariance_root(const Eigen::MatrixXd& a);

}  // namespace cablefit
