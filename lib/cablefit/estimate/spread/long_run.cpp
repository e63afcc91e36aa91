#include "cablefit/estimate/spread/long_run.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "cablefit/base/covariance_root.hpp"
#include "cablefit/estimate/spread/autoregression.hpp"

namespace cablefit {
namespace {

using std::numbers::pi;
constexpr double kMaxSum = 0.97;             // of the coefficients that prewhiten
constexpr Eigen::Index kEntriesPerLag = 16;  // of the series, for each order

double lag1_correlation(const Eigen::Ref<const Eigen::VectorXd>& x) {
  const Eigen::Index n = x.size();
  const double energy = x.squaredNorm();
  if (!(energy > 0)) return 0;
  return std::clamp(x.head(n - 1).dot(x.tail(n - 1)) / energy, -kMaxSum, kMaxSum);
}

double quadratic_spectral(double x) {
  if (std::abs(x) < 1e-8) return 1;
  const double a = 6 * pi * x / 5;
  return 25 / (12 * pi * pi * x * x) * (std::sin(a) / a - std::cos(a));
}

/// Takes out of a series what its own past predicts.
struct Prewhitening {
  Eigen::VectorXd coefficients;
  double sum = 0;                ///< of the coefficients
  double relative_variance = 0;  ///< of 1 / (1 - sum)^2, as the coefficients are estimated

  Eigen::Index order() const { return coefficients.size(); }
  Eigen::VectorXd apply(const Eigen::Ref<const Eigen::VectorXd>& x) const {
    Eigen::VectorXd out = x;
    for (Eigen::Index k = 0; k < order(); ++k)
      out.tail(x.size() - k - 1) -= coefficients(k) * x.head(x.size() - k - 1);
    return out;
  }
};

/// Biased autocovariances, so that they are positive definite.
Eigen::VectorXd autocovariance_of(const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::Index n_lags) {
  const Eigen::Index n = x.size();
  Eigen::VectorXd out(n_lags);
  for (Eigen::Index lag = 0; lag < n_lags; ++lag)
    out(lag) = x.head(n - lag).dot(x.tail(n - lag)) / static_cast<double>(n);
  return out;
}

/// The coefficients of an autoregression have the covariance v / n (autocovariance matrix)^-1, v of
/// the innovation (Brockwell & Davis 1991, ch. 8.1); by the delta method that of 1 / (1 - sum)^2.
double recolouring_variance(const Eigen::VectorXd& autocovariance, const Autoregression& found,
                            double sum, double n) {
  const auto order = static_cast<Eigen::Index>(found.coefficients.size());
  if (order == 0) return 0;
  Eigen::MatrixXd toeplitz(order, order);
  for (Eigen::Index i = 0; i < order; ++i)
    for (Eigen::Index j = 0; j < order; ++j) toeplitz(i, j) = autocovariance(std::abs(i - j));
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(order);
  const double of_sum = found.innovation_variance / n * ones.dot(toeplitz.ldlt().solve(ones));
  return 4 * of_sum / ((1 - sum) * (1 - sum));
}

Prewhitening prewhitening_of(const Eigen::Ref<const Eigen::VectorXd>& covariance, double n) {
  const Autoregression found = fit_autoregression(covariance, n);
  Prewhitening one;
  one.coefficients = Eigen::Map<const Eigen::VectorXd>(
      found.coefficients.data(), static_cast<Eigen::Index>(found.coefficients.size()));
  one.sum = found.sum();
  if (one.sum > kMaxSum) {
    one.coefficients *= kMaxSum / one.sum;
    one.sum = kMaxSum;
  }
  one.relative_variance = recolouring_variance(covariance, found, one.sum, n);
  return one;
}

/// One component: its autocovariances, and what the fit took out of them per unit of the level.
struct Component {
  Eigen::VectorXd seen, taken;
  double total = 0;
  double level = 0;  ///< long-run variance over total

  Component(const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::Index n_lags,
            const FittedOut* fitted, Eigen::Index k)
      : seen(autocovariance_of(x, n_lags)), taken(Eigen::VectorXd::Zero(n_lags)) {
    if (fitted == nullptr || !(fitted->total(k) > 0)) return;
    const Eigen::MatrixXd& z = fitted->columns[static_cast<std::size_t>(k)];
    for (Eigen::Index j = 0; j < z.cols(); ++j) taken += autocovariance_of(z.col(j), n_lags);
    total = fitted->total(k) / static_cast<double>(x.size());
    level = seen(0) / total;
  }
  Eigen::VectorXd whole() const { return seen + level * taken; }
};

/// Kernel sum of the prewhitened component, recoloured, from autocovariances; per entry.
double long_run_variance(const Eigen::VectorXd& covariance, const Prewhitening& filter,
                         double bandwidth) {
  Eigen::VectorXd a = Eigen::VectorXd::Zero(filter.order() + 1);
  a(0) = 1;
  a.tail(filter.order()) = -filter.coefficients;
  Eigen::VectorXd twice = Eigen::VectorXd::Zero(filter.order() + 1);  // autocorrelation of a
  for (Eigen::Index lag = 0; lag <= filter.order(); ++lag)
    twice(lag) = a.head(a.size() - lag).dot(a.tail(a.size() - lag));
  const auto at = [&](Eigen::Index lag) {
    lag = std::abs(lag);
    return lag < covariance.size() ? covariance(lag) : 0.0;
  };
  const auto whitened = [&](Eigen::Index lag) {
    double sum = twice(0) * at(lag);
    for (Eigen::Index j = 1; j < twice.size(); ++j) sum += twice(j) * (at(lag + j) + at(lag - j));
    return sum;
  };
  double total = whitened(0);
  const auto last = std::min<Eigen::Index>(covariance.size() - 1,
                                           static_cast<Eigen::Index>(std::ceil(5 * bandwidth)));
  for (Eigen::Index lag = 1; lag <= last; ++lag)
    total += 2 * quadratic_spectral(static_cast<double>(lag) / bandwidth) * whitened(lag);
  return total / ((1 - filter.sum) * (1 - filter.sum));
}

Eigen::Index lags_of_orders(Eigen::Index n, Eigen::Index max_order) {
  return 1 + std::clamp<Eigen::Index>(n / kEntriesPerLag, 1, max_order);
}

/// Puts back what the fit took out, prewhitening included; the diagonal's entries grow,
/// correlations stay.
void restore(const Eigen::Ref<const Eigen::MatrixXd>& series, const FittedOut& fitted,
             Eigen::Index max_order, LongRunCovariance& result) {
  constexpr int kPasses = 6;  // each adds less than a third of the one before, as a rule
  // Of a variance, by all passes: they need not converge where the prewhitening is near its cap.
  constexpr double kMostGrowth = 9;
  const auto n = static_cast<double>(series.rows());
  const Eigen::Index n_lags = std::min<Eigen::Index>(
      series.rows(), static_cast<Eigen::Index>(std::ceil(5 * result.bandwidth)) + max_order + 1);
  const Eigen::Index n_orders = std::min(n_lags, lags_of_orders(series.rows(), max_order));
  for (Eigen::Index k = 0; k < series.cols(); ++k) {
    Component component(series.col(k), n_lags, &fitted, k);
    if (!(component.total > 0) || !(result.covariance(k, k) > 0)) continue;
    double variance = result.covariance(k, k) / n;
    const double most = kMostGrowth * variance;
    for (int pass = 0; pass < kPasses; ++pass) {
      component.level = variance / component.total;
      const Eigen::VectorXd whole = component.whole();
      const double next =
          long_run_variance(whole, prewhitening_of(whole.head(n_orders), n), result.bandwidth);
      if (!(next > 0)) break;
      variance = std::min(next, most);
    }
    const double grow = std::sqrt(std::max(1.0, n * variance / result.covariance(k, k)));
    result.covariance.row(k) *= grow;
    result.covariance.col(k) *= grow;
  }
}

std::vector<Prewhitening> prewhitening_of(const Eigen::Ref<const Eigen::MatrixXd>& series,
                                          const FittedOut* fitted, Eigen::Index max_order) {
  const Eigen::Index n = series.rows();
  const Eigen::Index n_lags = lags_of_orders(n, max_order);
  std::vector<Prewhitening> all;
  for (Eigen::Index k = 0; k < series.cols(); ++k)
    all.push_back(prewhitening_of(Component(series.col(k), n_lags, fitted, k).whole(),
                                  static_cast<double>(n)));
  return all;
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

FittedOut fitted_out(const std::vector<Eigen::MatrixXd>& information,
                     const Eigen::MatrixXd& solve_operator) {
  const Eigen::Index p = solve_operator.rows(), n = static_cast<Eigen::Index>(information.size());
  const Eigen::MatrixXd root = covariance_root(solve_operator);
  FittedOut out;
  out.columns.assign(static_cast<std::size_t>(p), Eigen::MatrixXd::Zero(n, p));
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(p, p);
  for (Eigen::Index c = 0; c < n; ++c) {
    const Eigen::MatrixXd& own = information[static_cast<std::size_t>(c)];
    if (own.size() == 0) continue;
    all += own;
    const Eigen::MatrixXd z = root.transpose() * own * solve_operator;
    for (Eigen::Index k = 0; k < p; ++k)
      out.columns[static_cast<std::size_t>(k)].row(c) = z.col(k).transpose();
  }
  out.total = (solve_operator * all * solve_operator).diagonal();
  return out;
}

LongRunCovariance long_run_covariance(const Eigen::Ref<const Eigen::MatrixXd>& series,
                                      double least_share, const FittedOut* fitted,
                                      Eigen::Index max_order) {
  const Eigen::Index n = series.rows();
  const Eigen::Index p = series.cols();
  LongRunCovariance result;
  if (n < 8) {
    result.covariance = series.transpose() * series;
    result.bandwidth = 1;
    result.degrees_of_freedom = std::max<double>(1, static_cast<double>(n - p));
    return result;
  }
  const std::vector<Prewhitening> filters = prewhitening_of(series, fitted, max_order);
  Eigen::Index order = 0;
  for (const Prewhitening& one : filters) order = std::max(order, one.order());
  const Eigen::Index n_left = n - order;
  Eigen::MatrixXd white(n_left, p);
  Eigen::VectorXd recolour(p);
  double of_coefficients = 0;  // relative variance of the recolouring, of the worst component
  for (Eigen::Index k = 0; k < p; ++k) {
    const Prewhitening& one = filters[static_cast<std::size_t>(k)];
    white.col(k) = one.apply(series.col(k)).tail(n_left);
    recolour(k) = 1 / (1 - one.sum);
    of_coefficients = std::max(of_coefficients, one.relative_variance);
  }
  const double n_white = static_cast<double>(n_left);
  result.bandwidth = std::clamp(1.3221 * std::pow(andrews_alpha2(white) * n_white, 0.2),
                                std::max(1.0, least_share * n_white), n_white / 4);
  const double scale = static_cast<double>(n) / n_white;
  result.covariance =
      scale * recolour.asDiagonal() * kernel_sum(white, result.bandwidth) * recolour.asDiagonal();
  // Variance of a kernel estimate relative to its square is 2 (bandwidth/n) int k^2 = 2 / dof, and
  // int k^2 = 1 for the QS kernel. That of the prewhitening is added.
  const double relative_variance = 2 * result.bandwidth / n_white + of_coefficients;
  result.degrees_of_freedom = std::max(2.0, 2 / relative_variance);
  if (fitted != nullptr) restore(series, *fitted, max_order, result);
  return result;
}

LongRunCovariance interval_covariance(const Eigen::Ref<const Eigen::MatrixXd>& series,
                                      const FittedOut* fitted) {
  return long_run_covariance(series, kIntervalKernel, fitted, kIntervalOrder);
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
