#include "cablefit/base/parameter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace cablefit {
namespace {

void replace_all(std::string* text, std::string_view from, std::string_view to) {
  for (auto at = text->find(from); at != std::string::npos; at = text->find(from, at + to.size())) {
    text->replace(at, from.size(), to);
  }
}

}  // namespace

std::string linear_unit(std::string_view rotary_unit) {
  // A torque becomes a force, an inertia a mass, an angle a length; whatever is left stays.
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 3> kRules{
      {{"kg m^2", "kg"}, {"N m", "N"}, {"rad", "m"}}};
  std::string unit(rotary_unit);
  for (const auto& [rotary, linear] : kRules) replace_all(&unit, rotary, linear);
  return unit;
}

double Estimate::rsd_percent() const {
  return value == 0.0 ? std::numeric_limits<double>::quiet_NaN() : 100.0 * sd / std::abs(value);
}

const Estimate* find_estimate(const std::vector<Estimate>& estimates, std::string_view name) {
  const auto found = std::find_if(estimates.begin(), estimates.end(),
                                  [&](const Estimate& estimate) { return estimate.name == name; });
  return found == estimates.end() ? nullptr : &*found;
}

}  // namespace cablefit
