#include "cablefit/estimate/fit/parameter_estimate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/estimate/spread/long_run.hpp"

namespace cablefit {
namespace {

// Of the widths of an interval by the profile and by the sd: an sd a tenth as large says nothing.
constexpr double kBoundsDecide = 10;

}  // namespace

void set_interval(Estimate& e, double degrees_of_freedom, double lower) {
  const double t = t_quantile_975(degrees_of_freedom);
  e.ci_low = std::max(lower, e.value - t * e.sd);
  e.ci_high = e.value + t * e.sd;
}

void set_on_bound(Estimate& e, double unbounded, double degrees_of_freedom) {
  e.value = 0;
  e.ci_low = 0;
  e.ci_high = std::max(0.0, unbounded) + t_quantile_975(degrees_of_freedom) * e.sd;
}

void set_profile(Estimate& e, const ProfileInterval& profile, double extra, double lower) {
  if (!std::isfinite(profile.low) || !std::isfinite(profile.high)) return;
  const double stretch = std::sqrt(1 + extra);
  e.ci_low = std::max(lower, e.value - stretch * (e.value - profile.low));
  if (e.value == lower) e.ci_low = lower;  // not what rounding makes of it
  e.ci_high = e.value + stretch * (profile.high - e.value);
  e.profiled = true;
}

void widen_interval(Estimate& e, double factor) {
  const bool cut_off = !e.active_bound.empty() || e.ci_low == 0;
  e.sd *= factor;
  e.ci_high = e.value + factor * (e.ci_high - e.value);
  if (!cut_off) e.ci_low = e.value - factor * (e.value - e.ci_low);
}

bool is_held_by_bounds(const Estimate& e, double degrees_of_freedom) {
  const double width = 2 * t_quantile_975(degrees_of_freedom) * e.sd;
  return e.profiled && e.sd > 0 && e.ci_high - e.ci_low > kBoundsDecide * width;
}

Estimate estimate_of(const ParameterInfo& info, Axes axes, const LinearSolution& s, Eigen::Index k,
                     const SdChoice& choice) {
  Estimate e;
  e.name = info.name;
  e.symbol = info.symbol;
  e.unit = unit_for(axes, info.unit);
  e.not_identifiable = s.not_identifiable[static_cast<std::size_t>(k)];
  if (!e.not_identifiable.empty()) return e;
  e.value = s.x(k);
  const auto at = static_cast<std::size_t>(k);
  if (s.at_bound[at]) {
    e.active_bound = "at 0, where constraints hold it";
    if (info.lower == -kUnbounded) {
      if (!s.profile.empty()) set_profile(e, s.profile[at], 0, info.lower);
      return e;
    }
    e.active_bound = fmt::format("{} >= 0", e.name);
    e.sd = s.unbounded_sd(k);
    set_on_bound(e, s.unbounded_x(k), s.degrees_of_freedom);
    if (!s.profile.empty()) set_profile(e, s.profile[at], 0, info.lower);
    return e;
  }
  e.sd_white = std::sqrt(s.covariance_white(k, k));
  e.sd = choice.robust ? std::sqrt(s.covariance(k, k) + choice.extra_variance) : e.sd_white;
  set_interval(e, s.degrees_of_freedom, info.lower);
  if (!s.profile.empty())
    set_profile(e, s.profile[at], choice.robust ? choice.extra_variance / s.covariance(k, k) : 0,
                info.lower);
  return e;
}

}  // namespace cablefit
