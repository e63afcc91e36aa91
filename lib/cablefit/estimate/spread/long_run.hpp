// Long-run covariance of a serially correlated series: the main part of a robust standard
// deviation.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace cablefit {

struct LongRunCovariance {
  Eigen::MatrixXd covariance;     ///< p x p, of the SUM of the series over its n entries
  double bandwidth = 0;           ///< of the kernel, in entries
  double degrees_of_freedom = 0;  ///< equivalent, for t quantiles
};

/// Residuals are orthogonal to the regressors, so that the series of a fit's scores has hardly any
/// spectrum at zero frequency, just where it is looked for: of a blocked sweep's 13 s in which a
/// cable is taut a fifth of its sd was missing. With e = W x + noise and the influence a =
/// c'(W'W)^-1 W' of a parameter the expected product of two entries lacks s z_c'z_d, z_c = L' sum
/// over the entry of a_t w_t, L L' = (W'W)^-1, s the noise's level; it is put back into the
/// autocovariances, s from what they say then (unbiased for white noise; Hansen 2022,
/// Econometrics, 4.13, for one row).
struct FittedOut {
  std::vector<Eigen::MatrixXd> columns;  ///< per component, n x parameters: z_c
  Eigen::VectorXd total;                 ///< per component: sum of a_t^2, c'(W'W)^-1 c
};

/// `information`: per entry of the series the sum of w_t w_t'. `solve_operator`: (W'W)^-1, 0 where
/// a parameter is held.
FittedOut fitted_out(const std::vector<Eigen::MatrixXd>& information,
                     const Eigen::MatrixXd& solve_operator);

/// Heteroskedasticity and autocorrelation consistent (HAC) estimate: each component is prewhitened
/// by an autoregression of the order that AIC chooses (Andrews & Monahan 1992; den Haan & Levin
/// 1997), the quadratic-spectral kernel gets Andrews' (1991, eq. 6.4) data-driven bandwidth, but at
/// least `least_share` of the series, and the result is recoloured. An order of 1 is not enough:
/// slow noise below white noise has a small correlation at lag 1 and a long tail (ARMA(1,1)), of
/// which it missed 30 % of the variance. `series`: n x p, mean about zero (the scores of a fit),
/// evenly spaced, zeros where rows are missing; n >= 8 or the white estimate is returned.
/// `fitted`: what the fit took out of the series, see above; nullptr: nothing. `max_order`: of the
/// autoregressions. Tests that ask whether there is any structure at all are better off with 1: a
/// higher order takes the structure for slow noise.
LongRunCovariance long_run_covariance(const Eigen::Ref<const Eigen::MatrixXd>& series,
                                      double least_share = 0, const FittedOut* fitted = nullptr,
                                      Eigen::Index max_order = 1);

/// `least_share` for intervals. Andrews' bandwidth supposes a spectrum with its peak at zero and
/// smooths over a dip: slow noise times a fast regressor has one there, and its sd came out 1.4
/// times too large. A kernel this long leaves 64 degrees of freedom, which t quantiles pay for
/// (2.00 instead of 1.96): coverage wants longer kernels than the least mean square error does
/// (Sun, Phillips & Jin 2008, Econometrica 76:175). Tests that ask whether there is any correlation
/// at all are better off without.
inline constexpr double kIntervalKernel = 1.0 / 64;
inline constexpr Eigen::Index kIntervalOrder = 30;  ///< at most, of the autoregressions

/// The one rule for sd and intervals: long_run_covariance() with that kernel and order.
LongRunCovariance interval_covariance(const Eigen::Ref<const Eigen::MatrixXd>& series,
                                      const FittedOut* fitted = nullptr);

/// Quantile of Student's t at probability 0.975, for 95 % intervals. dof >= 1; large dof -> 1.96.
double t_quantile_975(double dof);

}  // namespace cablefit
