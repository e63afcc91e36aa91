#include "cablefit/estimate/f_distribution.hpp"

#include <cmath>

namespace cablefit {
namespace {

constexpr double kTiny = 1e-300;
constexpr double kPrecision = 1e-14;
constexpr int kMaxTerms = 10000;  // about sqrt(max(a, b)) are needed

double away_from_zero(double x) { return std::abs(x) < kTiny ? kTiny : x; }

/// Continued fraction of I_x(a, b), for x < (a + 1)/(a + b + 2).
double fraction(double a, double b, double x) {
  double c = 1;
  double d = 1 / away_from_zero(1 - (a + b) * x / (a + 1));
  double h = d;
  for (int m = 1; m <= kMaxTerms; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    d = 1 / away_from_zero(1 + even * d);
    c = away_from_zero(1 + even / c);
    h *= d * c;
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    d = 1 / away_from_zero(1 + odd * d);
    c = away_from_zero(1 + odd / c);
    h *= d * c;
    if (std::abs(d * c - 1) < kPrecision) break;
  }
  return h;
}

double incomplete_beta(double a, double b, double x) {
  if (x <= 0) return 0;
  if (x >= 1) return 1;
  const double front = std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) +
                                a * std::log(x) + b * std::log1p(-x));
  if (x < (a + 1) / (a + b + 2)) return front * fraction(a, b, x) / a;
  return 1 - front * fraction(b, a, 1 - x) / b;
}

}  // namespace

double f_upper_tail(double statistic, double dof_numerator, double dof_denominator) {
  if (!(statistic > 0)) return 1;
  const double x = dof_denominator / (dof_denominator + dof_numerator * statistic);
  return incomplete_beta(0.5 * dof_denominator, 0.5 * dof_numerator, x);
}

}  // namespace cablefit
