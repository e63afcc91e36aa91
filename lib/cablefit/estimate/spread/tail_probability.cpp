#include "cablefit/estimate/spread/tail_probability.hpp"

#include <cmath>

namespace cablefit {
namespace {

constexpr int kMostTerms = 10000;
constexpr double kSeriesPrecision = 1e-15;
constexpr double kTiny = 1e-300;  // instead of 0, in a denominator (Lentz 1976)

double lower_gamma_series(double a, double x) {
  double term = 1 / a, sum = term;
  for (int n = 1; n < kMostTerms && std::abs(term) > kSeriesPrecision * std::abs(sum); ++n) {
    term *= x / (a + n);
    sum += term;
  }
  return sum * std::exp(a * std::log(x) - x - std::lgamma(a));
}

double kept_from_zero(double x) { return std::abs(x) < kTiny ? kTiny : x; }

double upper_gamma_fraction(double a, double x) {
  double b = x + 1 - a, c = 1 / kTiny, d = 1 / kept_from_zero(b), h = d;
  for (int n = 1; n < kMostTerms; ++n) {
    const double an = -n * (n - a);
    b += 2;
    d = 1 / kept_from_zero(an * d + b);
    c = kept_from_zero(b + an / c);
    const double change = c * d;
    h *= change;
    if (std::abs(change - 1) < kSeriesPrecision) break;
  }
  return h * std::exp(a * std::log(x) - x - std::lgamma(a));
}

/// The continued fraction of I_x(a, b), for x < (a + 1)/(a + b + 2).
double beta_fraction(double a, double b, double x) {
  double c = 1, d = 1 / kept_from_zero(1 - (a + b) * x / (a + 1)), h = d;
  const auto step = [&](double coefficient) {
    d = 1 / kept_from_zero(1 + coefficient * d);
    c = kept_from_zero(1 + coefficient / c);
    h *= c * d;
    return std::abs(c * d - 1);
  };
  for (int m = 1; m < kMostTerms; ++m) {
    step(m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m)));
    if (step(-(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1))) < kSeriesPrecision)
      break;
  }
  return h;
}

/// I_x(a, b); `y` = 1 - x, which keeps its digits when x is nearly 1.
double incomplete_beta(double a, double b, double x, double y) {
  if (!(x > 0)) return 0;
  if (!(y > 0)) return 1;
  const double front = std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) +
                                a * std::log(x) + b * std::log(y));
  if (x < (a + 1) / (a + b + 2)) return front * beta_fraction(a, b, x) / a;
  return 1 - front * beta_fraction(b, a, y) / b;
}

}  // namespace

double chi_squared_tail(double x, double dof) {
  if (!(x > 0)) return 1;
  const double a = dof / 2, half = x / 2;
  return half < a + 1 ? 1 - lower_gamma_series(a, half) : upper_gamma_fraction(a, half);
}

double f_tail(double x, double dof_1, double dof_2) {
  if (!(x > 0)) return 1;
  const double total = dof_2 + dof_1 * x;
  return incomplete_beta(dof_2 / 2, dof_1 / 2, dof_2 / total, dof_1 * x / total);
}

double t_tail(double x, double dof) { return f_tail(x * x, 1, dof); }

double t_quantile(double probability, double dof) {
  double low = 0, high = 1;
  while (t_tail(high, dof) > probability) high *= 2;
  while (high - low > 1e-13 * high) {
    const double middle = low + (high - low) / 2;
    (t_tail(middle, dof) > probability ? low : high) = middle;
  }
  return high;
}

}  // namespace cablefit
