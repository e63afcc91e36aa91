// Minimum of a function of one variable. Internal to refine/.
#pragma once

#include <cmath>

namespace cablefit {

/// The minimum of `error` over [low, high], by golden section (Kiefer 1953), exact to 0.618^steps
/// of the range, which is 1 %.
template <typename Error>
double golden(double low, double high, Error error) {
  constexpr int kSteps = 9;
  const double ratio = (std::sqrt(5.0) - 1) / 2;
  double a = high - ratio * (high - low), b = low + ratio * (high - low);
  double at_a = error(a), at_b = error(b);
  for (int i = 0; i < kSteps; ++i) {
    if (at_a < at_b) {
      high = b;
      b = a;
      at_b = at_a;
      at_a = error(a = high - ratio * (high - low));
    } else {
      low = a;
      a = b;
      at_a = at_b;
      at_b = error(b = low + ratio * (high - low));
    }
  }
  return at_a < at_b ? a : b;
}

}  // namespace cablefit
