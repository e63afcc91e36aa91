// Autoregressive model of a stationary series, from its autocovariance.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace cablefit {

/// x_i = sum_k coefficients[k] x_(i-1-k) + innovation.
struct Autoregression {
  std::vector<double> coefficients;
  double innovation_variance = 0;  ///< in the square of the series' unit

  /// Sum of the coefficients: the spectrum at zero frequency is innovation_variance / (1 - sum)^2.
  double sum() const;
};

/// Yule-Walker equations by the recursion of Levinson 1946 and Durbin 1960, of the order below
/// autocovariance.size() that has the least AIC (Akaike 1974) for `n_values`. `autocovariance`:
/// lags 0, 1, ... The order ends where the autocovariance is not positive definite; lag 0 not
/// positive, or no values: order 0 and no innovation.
Autoregression fit_autoregression(const Eigen::Ref<const Eigen::VectorXd>& autocovariance,
                                  double n_values);

}  // namespace cablefit
