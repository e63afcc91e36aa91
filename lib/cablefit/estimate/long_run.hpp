// Long-run covariance of a serially correlated series: the heart of an honest standard deviation.
#pragma once

#include <Eigen/Core>

namespace cablefit {

struct LongRunCovariance {
  Eigen::MatrixXd covariance;     ///< p x p, of the SUM of the series over its n entries
  double bandwidth = 0;           ///< of the kernel, in entries
  double degrees_of_freedom = 0;  ///< equivalent, for t quantiles
};

/// Heteroskedasticity and autocorrelation consistent (HAC) estimate: each component is prewhitened
/// by an AR(1) with |rho| <= 0.97 (Andrews & Monahan 1992), the quadratic-spectral kernel gets
/// Andrews' (1991, eq. 6.4) data-driven bandwidth, and the result is recoloured. `series`: n x p,
/// mean about zero (the scores of a fit), n >= 8 or the white estimate is returned.
LongRunCovariance long_run_covariance(const Eigen::Ref<const Eigen::MatrixXd>& series);

/// Quantile of Student's t at probability 0.975, for 95 % intervals. dof >= 1; large dof -> 1.96.
double t_quantile_975(double dof);

}  // namespace cablefit
