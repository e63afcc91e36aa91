#include "cablefit/estimate/spread/autoregression.hpp"

#include <cmath>
#include <numeric>

namespace cablefit {
namespace {

constexpr double kLargestReflection = 0.999;  // more is a root on the unit circle: no noise

}  // namespace

double Autoregression::sum() const {
  return std::accumulate(coefficients.begin(), coefficients.end(), 0.0);
}

Autoregression fit_autoregression(const Eigen::Ref<const Eigen::VectorXd>& r, double n_values) {
  Autoregression best;
  if (r.size() == 0 || !(r(0) > 0) || !(n_values > 0)) return best;
  best.innovation_variance = r(0);
  std::vector<double> a;
  double variance = r(0), least = n_values * std::log(variance);
  for (Eigen::Index order = 1; order < r.size(); ++order) {
    double left = r(order);
    for (std::size_t k = 0; k < a.size(); ++k)
      left -= a[k] * r(order - 1 - static_cast<Eigen::Index>(k));
    const double reflection = left / variance;
    if (!(std::abs(reflection) < kLargestReflection)) break;
    std::vector<double> next = a;
    for (std::size_t k = 0; k < a.size(); ++k) next[k] -= reflection * a[a.size() - 1 - k];
    next.push_back(reflection);
    a = std::move(next);
    variance *= 1 - reflection * reflection;
    const double aic = n_values * std::log(variance) + 2 * static_cast<double>(order);
    if (aic >= least) continue;
    least = aic;
    best = {a, variance};
  }
  return best;
}

}  // namespace cablefit
