#include "cablefit/refine/null/chance_tail.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cablefit {
namespace {

double count_beyond(const std::vector<double>& largest, std::size_t from, std::size_t to,
                    double gain) {
  double n = 0;
  for (std::size_t k = from; k < to; ++k) n += largest[k] >= gain ? 1 : 0;
  return n;
}

/// P(none of the first and at most `counted` of the `n_later` draws after them are beyond): of n
/// draws and the value itself every order is as likely, so that j draws are beyond it with 1 / (n +
/// 1), and all j are among the later ones with C(n_later, j) / C(n, j).
double tail_of_later(double n, double n_later, double counted) {
  double sum = 0, term = 1 / (n + 1);
  for (double j = 0; j <= counted; ++j) {
    sum += term;
    term *= (n_later - j) / (n - j);
  }
  return sum;
}

}  // namespace

double least_tail(std::size_t n_draws) {
  constexpr double kBeyond = 0.01, kLeast = 1e-4;
  return std::max(kLeast, kBeyond / (1 + static_cast<double>(n_draws)));
}

ChanceTail tail_of_largest(const std::vector<double>& largest, double gain) {
  const auto n = static_cast<double>(largest.size());
  if (largest.size() < 2) return {};
  double sum = 0, squares = 0;
  for (const double one : largest) sum += one;
  const double above = count_beyond(largest, 0, largest.size(), gain);
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

ChanceTail tail_of_sequence(const std::vector<double>& largest, double gain) {
  const std::size_t n = largest.size(), first = std::min(n, kFirstDraws);
  const double of_first = count_beyond(largest, 0, first, gain);
  const double of_later = count_beyond(largest, first, n, gain);
  if (n == first || of_first + of_later == 0) return tail_of_largest(largest, gain);
  if (of_first > 0) return {(1 + of_first) / (1 + static_cast<double>(first)), false};
  return {tail_of_later(static_cast<double>(n), static_cast<double>(n - first), of_later), false};
}

}  // namespace cablefit
