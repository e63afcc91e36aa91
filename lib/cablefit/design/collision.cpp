#include "cablefit/design/collision.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "cablefit/base/root.hpp"

namespace cablefit {
namespace {

constexpr double kSecondsPerHour = 3600;
constexpr double kFarthestSd = 40;  // beyond, no double is left of the normal tail

/// 1 - Phi(x).
double upper_tail(double x) { return 0.5 * std::erfc(x / std::sqrt(2.0)); }

}  // namespace

double exceedance(double e, double s, double threshold) {
  if (s == 0) return std::abs(e) > threshold ? 1 : 0;
  return upper_tail((threshold - e) / s) + upper_tail((threshold + e) / s);
}

double false_alarm_rate_of(double alarms_per_hour, double window) {
  return alarms_per_hour * window / kSecondsPerHour;
}

CollisionThreshold collision_threshold(const CollisionDetector& d) {
  assert(d.false_alarm_rate > 0 && d.false_alarm_rate < d.detection_rate && d.detection_rate < 1);
  assert(d.noise >= 0 && d.rate > 0 && d.window > 0 && d.model_error >= 0);
  CollisionThreshold out;
  // A window of 0.05 s at 1 kHz is 50 rows, however 0.05 * 1000 is rounded.
  out.n_rows = std::max(1, static_cast<int>(std::floor(d.window * d.rate + 1e-6)));
  out.mean_noise = d.mean_noise.value_or(d.noise / std::sqrt(static_cast<double>(out.n_rows)));
  out.delay = 2 * d.window;
  if (out.mean_noise == 0) {
    out.threshold = d.model_error;
    out.torque = 2 * d.model_error;
    return out;
  }
  // In units of the mean's sd, so that the bounds of the search are known.
  const double bias = d.model_error / out.mean_noise;
  const double threshold = root_between(
      [&](double h) { return d.false_alarm_rate - exceedance(bias, 1, h); }, 0, bias + kFarthestSd);
  const double contact =
      root_between([&](double c) { return exceedance(c - bias, 1, threshold) - d.detection_rate; },
                   bias, bias + threshold + kFarthestSd);
  out.threshold = threshold * out.mean_noise;
  out.torque = contact * out.mean_noise;
  return out;
}

}  // namespace cablefit
