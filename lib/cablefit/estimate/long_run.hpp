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
/// Andrews' (1991, eq. 6.4) data-driven bandwidth, but at least `least_share` of the series, and
/// the result is recoloured. `series`: n x p, mean about zero (the scores of a fit), n >= 8 or the
/// white estimate is returned.
LongRunCovariance long_run_covariance(const Eigen::Ref<const Eigen::MatrixXd>& series,
                                      double least_share = 0);

/// `least_share` for intervals. Andrews' bandwidth supposes a spectrum with its peak at zero and
/// smooths over a dip: slow noise times a fast regressor has one there, and its sd came out 1.4
/// times too large. A kernel this long leaves 64 degrees of freedom, which t quantiles pay for
/// (2.00 instead of 1.96): coverage wants longer kernels than the least mean square error does
/// (Sun, Phillips & Jin 2008, Econometrica 76:175). Tests that ask whether there is any correlation
/// at all are better off without.
inline constexpr double kIntervalKernel = 1.0 / 64;

/// The one rule for sd and intervals: long_run_covariance() with that kernel.
LongRunCovariance interval_covariance(const Eigen::Ref<const Eigen::MatrixXd>& series);

/// Quantile of Student's t at probability 0.975, for 95 % intervals. dof >= 1; large dof -> 1.96.
double t_quantile_975(double dof);

}  // namespace cablefit
