#include "cablefit/base/parameter.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cablefit {

double Estimate::rsd_percent() const {
  return value == 0.0 ? kNotKnown : 100.0 * sd / std::abs(value);
}

Estimate refused_estimate(const Estimate& of, std::string why) {
  Estimate refused;
  refused.name = of.name;
  refused.symbol = of.symbol;
  refused.unit = of.unit;
  refused.not_identifiable = std::move(why);
  return refused;
}

const Estimate* find_estimate(const std::vector<Estimate>& estimates, std::string_view name) {
  const auto found = std::find_if(estimates.begin(), estimates.end(),
                                  [&](const Estimate& estimate) { return estimate.name == name; });
  return found == estimates.end() ? nullptr : &*found;
}

}  // namespace cablefit
