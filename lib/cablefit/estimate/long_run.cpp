#include "cablefit/estimate/long_run.hpp"

#include <algorithm>
#include <cmath>

namespace cablefit {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kMaxRho = 0.97;

double lag1_correlation(const Eigen::Ref<const Eigen::VectorXd>& x) {
  const Eigen::Index n = x.size();
  const double energy = x.squaredNorm();
  if (!(energy > 0)) return 0;
  return std::clamp(x.head(n - 1).dot(x.tail(n - 1)) / energy, -kMaxRho, kMaxRho);
}

// Andrews (1991) eq. 6.4 for AR(1) components of equal weight; alpha(2) for the QS kernel.
double andrews_alpha2(const Eigen::MatrixXd& residual) {
  double numerator = 0;
  double denominator = 0;
  for (Eigen::Index k = 0; k < residual.cols(); ++k) {
    const double rho = lag1_correlation(residual.col(k));
    const double variance = residual.col(k).squaredNorm() / static_cast<double>(residual.rows());
    if (!(variance > 0)) continue;
    // The weight 1/variance^2 makes the answer independent of the units of each component.
    numerator += 4 * rho * rho / std::pow(1 - rho, 8);
    denominator += 1 / std::pow(1 - rho, 4);
  }
  return denominator > 0 ? numerator / denominator : 0;
}

double quadratic_spectral(double x) {
  if (std::abs(x) < 1e-8) return 1;
  const double a = 6 * kPi * x / 5;
  return 25 / (12 * kPi * kPi * x * x) * (std::sin(a) / a - std::cos(a));
}

Eigen::MatrixXd kernel_sum(const Eigen::MatrixXd& v, double bandwidth) {
  Eigen::MatrixXd total = v.transpose() * v;
  // Beyond five bandwidths the kernel's ripple is below 1 % of its value at zero.
  const Eigen::Index last =
      std::min<Eigen::Index>(v.rows() - 1, static_cast<Eigen::Index>(std::ceil(5 * bandwidth)));
  for (Eigen::Index lag = 1; lag <= last; ++lag) {
    const double weight = quadratic_spectral(static_cast<double>(lag) / bandwidth);
    const Eigen::MatrixXd gamma =
        v.bottomRows(v.rows() - lag).transpose() * v.topRows(v.rows() - lag);
    total += weight * (gamma + gamma.transpose());
  }
  return total;
}

}  // namespace

LongRunCovariance long_run_covariance(const Eigen::Ref<const Eigen::MatrixXd>& series,
                                      double least_share) {
  const Eigen::Index n = series.rows();
  const Eigen::Index p = series.cols();
  LongRunCovariance result;
  if (n < 8) {
    result.covariance = series.transpose() * series;
    result.bandwidth = 1;
    result.degrees_of_freedom = std::max<double>(1, static_cast<double>(n - p));
    return result;
  }
  Eigen::VectorXd rho(p);
  Eigen::MatrixXd white(n - 1, p);
  for (Eigen::Index k = 0; k < p; ++k) {
    rho(k) = lag1_correlation(series.col(k));
    white.col(k) = series.col(k).tail(n - 1) - rho(k) * series.col(k).head(n - 1);
  }
  const double n_white = static_cast<double>(n - 1);
  result.bandwidth = std::clamp(1.3221 * std::pow(andrews_alpha2(white) * n_white, 0.2),
                                std::max(1.0, least_share * n_white), n_white / 4);
  const Eigen::VectorXd recolour = (1 - rho.array()).inverse();
  const double scale = static_cast<double>(n) / n_white;
  result.covariance =
      scale * recolour.asDiagonal() * kernel_sum(white, result.bandwidth) * recolour.asDiagonal();
  // Variance of a kernel estimate relative to its square is 2 (bandwidth/n) int k^2 = 2 / dof, and
  // int k^2 = 1 for the QS kernel. The prewhitening coefficient is estimated too: its own error,
  // (d log 1/(1-rho)^2)^2 var(rho) with var(rho) = (1-rho^2)/n, is added.
  const double worst = rho.cwiseAbs().maxCoeff();
  const double relative_variance = 2 * result.bandwidth / n_white +
                                   4 * (1 - worst * worst) / ((1 - worst) * (1 - worst)) / n_white;
  result.degrees_of_freedom = std::max(2.0, 2 / relative_variance);
  return result;
}

LongRunCovariance interval_covariance(const Eigen::Ref<const Eigen::MatrixXd>& series) {
  return long_run_covariance(series, kIntervalKernel);
}

double t_quantile_975(double dof) {
  // Cornish-Fisher expansion about the normal quantile (Abramowitz & Stegun 26.7.5); error below
  // 1 % for dof >= 3, exact forms below.
  if (dof < 1.5) return 12.706;
  if (dof < 2.5) return 4.303;
  const double z = 1.959963984540054;
  const double z2 = z * z;
  const double g1 = (z2 + 1) * z / 4;
  const double g2 = ((5 * z2 + 16) * z2 + 3) * z / 96;
  const double g3 = (((3 * z2 + 19) * z2 + 17) * z2 - 15) * z / 384;
  const double g4 = ((((79 * z2 + 776) * z2 + 1482) * z2 - 1920) * z2 - 945) * z / 92160;
  return z + g1 / dof + g2 / (dof * dof) + g3 / std::pow(dof, 3) + g4 / std::pow(dof, 4);
}

}  // namespace cablefit
