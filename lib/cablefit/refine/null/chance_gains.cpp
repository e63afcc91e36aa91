#include "cablefit/refine/null/chance_gains.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cablefit {
namespace {

constexpr double kLeastUnit = 1e-9;
constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

/// Kind of an event: lasting or passing. A search over times gains more under the null, and a
/// passing event is judged in sample.
std::size_t occurrence_of(const Effect& row) { return row.lasts() ? 0 : 1; }

/// A gain as a log ratio of squared errors, which is not bounded by 1 (Wilks 1938).
double log_ratio(double gain) {
  constexpr double kMost = 1 - 1e-12;
  return -std::log1p(-std::clamp(gain, 0.0, kMost));
}

}  // namespace

ChanceGains::ChanceGains(const std::vector<NullDraw>& draws) {
  const std::size_t n = draws.size();
  for (std::size_t k = 0; k < n; ++k)
    for (const auto& [row, gain] : draws[k].gains)
      gains_.try_emplace(row, n, 0.0).first->second[k] = log_ratio(gain);

  std::vector<double> of_rows;
  for (const auto& [row, gains] : gains_)
    if (!row->is_event) of_rows.push_back(rms_without(*row, kAll));
  if (!of_rows.empty()) {
    const auto middle = of_rows.begin() + static_cast<std::ptrdiff_t>(of_rows.size() / 2);
    std::nth_element(of_rows.begin(), middle, of_rows.end());
    median_ = *middle;
  }

  always_.assign(n, 0);
  in_units_.assign(n, 0);
  events_.assign(n, 0);
  for (std::size_t k = 0; k < n; ++k) {
    std::array<double, 2> most{};
    for (const auto& [row, gains] : gains_) {
      double& largest = row->is_event ? most[occurrence_of(*row)] : always_[k];
      largest = std::max(largest, gains[k]);
      // Without the draw itself, as the logs' own gain has no part in its unit.
      if (!row->is_event) in_units_[k] = std::max(in_units_[k], gains[k] / unit(*row, k));
    }
    events_[k] = std::max(most[0], most[1]);
    for (std::size_t i = 0; i < most.size(); ++i)
      mean_events_[i] += most[i] / static_cast<double>(n);
  }
}

double ChanceGains::rms_without(const Effect& row, std::size_t but) const {
  const auto found = gains_.find(&row);
  if (found == gains_.end()) return 0;
  double squares = 0, n = 0;
  for (std::size_t k = 0; k < found->second.size(); ++k) {
    if (k == but) continue;
    squares += found->second[k] * found->second[k];
    ++n;
  }
  return n > 0 ? std::sqrt(squares / n) : 0;
}

double ChanceGains::unit(const Effect& row, std::size_t but) const {
  // Some rows gain nothing but once: by their own rms alone that once would be beyond all measure.
  return std::max(kLeastUnit, std::hypot(rms_without(row, but), median_));
}

ChanceTail ChanceGains::tail_of_search(double gain) const {
  return tail_of_sequence(always_, log_ratio(gain));
}

ChanceTail ChanceGains::tail(const Effect& row, double share) const {
  const double gain = log_ratio(share);
  if (row.is_event) return tail_of_largest(events_, gain);
  const ChanceTail plain = tail_of_largest(always_, gain);
  const ChanceTail in_units = tail_of_largest(in_units_, gain / unit(row, kAll));
  ChanceTail smaller = in_units.p < plain.p ? in_units : plain;
  if (smaller.p > least_tail(always_.size())) smaller.p = std::min(1.0, 2 * smaller.p);
  return smaller;
}

bool ChanceGains::is_beyond(const Effect& row, double share, double times) const {
  const double gain = log_ratio(share);
  const auto beats = [times](const std::vector<double>& largest, double value) {
    return largest.empty() || value > times * *std::max_element(largest.begin(), largest.end());
  };
  if (row.is_event) return beats(events_, gain);
  return beats(always_, gain) || beats(in_units_, gain / unit(row, kAll));
}

double ChanceGains::usual(const Effect& row) const {
  if (always_.empty()) return 0;
  return -std::expm1(-(row.is_event ? mean_events_[occurrence_of(row)] : unit(row, kAll)));
}

}  // namespace cablefit
