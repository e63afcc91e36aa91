#include "cablefit/refine/null/chance_tail.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cablefit {

double least_tail(std::size_t n_draws) {
  constexpr double kBeyond = 0.01, kLeast = 1e-4;
  return std::max(kLeast, kBeyond / (1 + static_cast<double>(n_draws)));
}

ChanceTail tail_of_largest(const std::vector<double>& largest, double gain) {
  const auto n = static_cast<double>(largest.size());
  if (largest.size() < 2) return {};
  double sum = 0, squares = 0, above = 0;
  for (const double one : largest) {
    sum += one;
    above += one >= gain ? 1 : 0;
  }
  const double mean = sum / n;
  for (const double one : largest) squares += (one - mean) * (one - mean);
  const double counted = (1 + above) / (1 + n);
  if (above > 0) return {counted, false};
  // Gumbel: sd = pi/sqrt(6) scale, mean = mode + gamma scale (Johnson, Kotz & Balakrishnan 1995).
  // Its upper tail is exponential, and mode and scale are known from few draws: the next value of
  // an exponential distribution with an estimated scale has a Pareto tail.
  const double scale =
      std::max(1e-12, std::sqrt(squares / (n - 1)) * std::sqrt(6.0) / std::numbers::pi);
  const double mode = mean - std::numbers::egamma * scale;
  const double k = n - 1, reach = 1 + (gain - mode) / scale / k;
  const double tail = reach > 0 ? -std::expm1(-std::pow(reach, -k)) : 1;
  if (tail >= counted) return {counted, false};
  return {std::max(least_tail(largest.size()), tail), true};
}

}  // namespace cablefit
