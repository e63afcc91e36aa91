#include "cablefit/estimate/parameter_estimate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/estimate/long_run.hpp"

namespace cablefit {

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

Estimate estimate_of(const ParameterInfo& info, bool linear_motion, const LinearSolution& s,
                     Eigen::Index k, const SdChoice& choice) {
  Estimate e;
  e.name = info.name;
  e.symbol = info.symbol;
  e.unit = linear_motion ? linear_unit(info.unit) : std::string(info.unit);
  e.not_identifiable = s.not_identifiable[static_cast<std::size_t>(k)];
  if (!e.not_identifiable.empty()) return e;
  e.value = s.x(k);
  if (s.at_bound[static_cast<std::size_t>(k)]) {
    e.active_bound = "at 0, where constraints hold it";
    if (info.lower == -kUnbounded) return e;
    e.active_bound = fmt::format("{} >= 0", e.name);
    e.sd = s.unbounded_sd(k);
    set_on_bound(e, s.unbounded_x(k), s.degrees_of_freedom);
    return e;
  }
  e.sd_white = std::sqrt(s.covariance_white(k, k));
  e.sd = choice.honest ? std::sqrt(s.covariance(k, k) + choice.extra_variance) : e.sd_white;
  set_interval(e, s.degrees_of_freedom, info.lower);
  return e;
}

}  // namespace cablefit
