#include "cablefit/base/window_mean.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace cablefit {

double sd_of_mean(std::span<const WindowMean> all, double seconds) {
  assert(!all.empty());
  if (seconds <= all.front().seconds) return all.front().sd;
  const WindowMean& last = all.back();
  if (seconds >= last.seconds) return last.sd * std::sqrt(last.seconds / seconds);
  const auto above = std::upper_bound(
      all.begin(), all.end(), seconds,
      [](double length, const WindowMean& window) { return length < window.seconds; });
  const WindowMean& below = *(above - 1);
  if (!(below.sd > 0) || !(above->sd > 0)) return std::max(below.sd, above->sd);
  const double share = std::log(seconds / below.seconds) / std::log(above->seconds / below.seconds);
  return below.sd * std::pow(above->sd / below.sd, share);
}

}  // namespace cablefit
