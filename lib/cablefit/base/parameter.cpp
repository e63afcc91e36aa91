#include "cablefit/base/parameter.hpp"

#include <algorithm>
#include <cmath>

namespace cablefit {

double Estimate::rsd_percent() const {
  return value == 0.0 ? std::numeric_limits<double>::quiet_NaN() : 100.0 * sd / std::abs(value);
}

const Estimate* find_estimate(const std::vector<Estimate>& estimates, std::string_view name) {
  const auto found = std::find_if(estimates.begin(), estimates.end(),
                                  [&](const Estimate& estimate) { return estimate.name == name; });
  return found == estimates.end() ? nullptr : &*found;
}

}  // namespace cablefit
