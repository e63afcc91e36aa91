#include "cablefit/design/curves/preload_line.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

#include "cablefit/base/root.hpp"
#include "cablefit/estimate/spread/tail_probability.hpp"

namespace cablefit {
namespace {

constexpr int kSlopeSteps = 20;   // the effective variances depend on the slope
constexpr double kMostDof = 1e6;  // beyond, t is normal
constexpr double kExact = 1e-12;  // of the range of y: sd of what is exact
constexpr double kAlike = 1e-6;   // of the range of x, beside it

double square(double x) { return x * x; }

/// The weighted line; variances of its middle and slope.
PreloadLine weighted_line(std::span<const PreloadEstimate> all, std::span<const double> variances,
                          double more) {
  PreloadLine line;
  double sum = 0;
  for (std::size_t i = 0; i < all.size(); ++i) sum += 1 / (variances[i] + more);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double share = 1 / (variances[i] + more) / sum;
    line.middle_x += share * all[i].x;
    line.middle_y += share * all[i].y;
  }
  double squares = 0, products = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double weight = 1 / (variances[i] + more), x = all[i].x - line.middle_x;
    squares += weight * x * x;
    products += weight * x * (all[i].y - line.middle_y);
  }
  line.slope = products / squares;
  line.var_middle = 1 / sum;
  line.var_slope = 1 / squares;
  return line;
}

double chi_squared(std::span<const PreloadEstimate> all, std::span<const double> variances,
                   double more) {
  const PreloadLine line = weighted_line(all, variances, more);
  double sum = 0;
  for (std::size_t i = 0; i < all.size(); ++i)
    sum += square(all[i].y - line.value(all[i].x)) / (variances[i] + more);
  return sum;
}

/// Variance that makes chi-squared equal its degrees of freedom; 0 where it is no larger.
double misfit_variance(std::span<const PreloadEstimate> all, std::span<const double> variances) {
  const auto dof = static_cast<double>(all.size()) - 2;
  if (dof <= 0) return 0;
  const auto excess = [&](double more) { return chi_squared(all, variances, more) - dof; };
  if (excess(0) <= 0) return 0;
  double more = *std::max_element(variances.begin(), variances.end());
  while (excess(more) > 0) more *= 4;
  return root_between(excess, 0, more);
}

std::vector<double> effective_variances(std::span<const PreloadEstimate> all, double slope,
                                        double least) {
  std::vector<double> variances;
  for (const PreloadEstimate& e : all)
    variances.push_back(std::max(e.var_y - 2 * slope * e.cov + slope * slope * e.var_x, least));
  return variances;
}

template <typename Number>
std::pair<double, double> range_of(std::span<const PreloadEstimate> all, Number number) {
  double low = number(all.front()), high = low;
  for (const PreloadEstimate& e : all) {
    low = std::min(low, number(e));
    high = std::max(high, number(e));
  }
  return {low, high};
}

double quantile_of(std::size_t n, std::span<const double> variances, double misfit) {
  double known = 0;
  for (const double v : variances) known += v / static_cast<double>(n);
  const double dof =
      misfit > 0 ? static_cast<double>(n - 2) * square((known + misfit) / misfit) : kMostDof;
  return t_quantile(0.05, std::min(dof, kMostDof));
}

}  // namespace

PreloadLine fit_preload_line(std::span<const PreloadEstimate> all) {
  assert(all.size() >= 2);
  const auto [y_low, y_high] = range_of(all, [](const PreloadEstimate& e) { return e.y; });
  const auto [x_low, x_high] = range_of(all, [](const PreloadEstimate& e) { return e.x; });
  const double size = std::max({y_high - y_low, std::abs(y_high), std::abs(y_low)});
  const double least = std::max(square(kExact * size), std::numeric_limits<double>::min());
  std::vector<double> variances = effective_variances(all, 0, least);
  for (int i = 0; i < kSlopeSteps; ++i)
    variances = effective_variances(all, weighted_line(all, variances, 0).slope, least);
  const auto dof = static_cast<double>(all.size()) - 2;
  const double misfit = misfit_variance(all, variances);
  PreloadLine line = weighted_line(all, variances, misfit);
  line.misfit = std::sqrt(misfit);
  if (dof > 0) line.p_value = chi_squared_tail(chi_squared(all, variances, 0), dof);
  line.t_quantile = quantile_of(all.size(), variances, misfit);
  line.low = std::max(std::min(0.0, x_low), x_low - kBeyond * (x_high - x_low));
  line.high = x_high + kBeyond * (x_high - x_low);
  const bool nothing_known =
      std::all_of(variances.begin(), variances.end(), [&](double v) { return v <= least; });
  if (dof == 0 && nothing_known)
    line.var_middle = line.var_slope = std::numeric_limits<double>::quiet_NaN();
  return line;
}

double PreloadLine::intercept_sd() const {
  return std::sqrt(var_middle + square(middle_x) * var_slope);
}

double PreloadLine::slope_sd() const { return std::sqrt(var_slope); }

double PreloadLine::sd(double x) const {
  return std::sqrt(var_middle + square(x - middle_x) * var_slope + square(misfit));
}

bool PreloadLine::holds(double x) const {
  const double hair = kAlike * (high - low);
  return x >= low - hair && x <= high + hair;
}

}  // namespace cablefit
