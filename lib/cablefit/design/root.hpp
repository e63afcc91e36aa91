// Where a continuous function has a value. Internal to design/.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

namespace cablefit {

inline constexpr int kRootSteps = 300;

/// x between a and b with f(x) = 0, where f(a) and f(b) differ in sign: regula falsi with Illinois
/// weights (Dowell & Jarratt 1971), bisected where that is slow; to the last bits of x.
template <typename Function>
double root_between(Function f, double a, double b) {
  double fa = f(a), fb = f(b);
  if (fa == 0) return a;
  for (int i = 0; i < kRootSteps && fb != 0 && a != b; ++i) {
    double c = i % 4 == 3 ? (a + b) / 2 : (a * fb - b * fa) / (fb - fa);
    if (!(c > std::min(a, b) && c < std::max(a, b))) c = (a + b) / 2;
    if (c == a || c == b) break;
    const double fc = f(c);
    if ((fc > 0) != (fb > 0)) {
      a = b;
      fa = fb;
    } else {
      fa /= 2;
    }
    b = c;
    fb = fc;
  }
  return b;
}

/// The first x = step, 2 step, 4 step, ... within `limit` at which f is at least 0, made exact;
/// f(0) is below 0. `step` and `limit` have one sign. Nothing when f stays below 0.
template <typename Function>
std::optional<double> root_outward(Function f, double step, double limit) {
  double from = 0;
  for (double to = step; std::abs(to) <= std::abs(limit); from = to, to *= 2)
    if (!(f(to) < 0)) return root_between(f, from, to);
  return std::nullopt;
}

}  // namespace cablefit
