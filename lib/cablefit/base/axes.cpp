#include "cablefit/base/axes.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace cablefit {
namespace {

void replace_all(std::string* text, std::string_view from, std::string_view to) {
  for (auto at = text->find(from); at != std::string::npos; at = text->find(from, at + to.size())) {
    text->replace(at, from.size(), to);
  }
}

/// A torque becomes a force, an inertia a mass, an angle a length; whatever is left stays.
std::string linear_unit(std::string_view rotary_unit) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 3> kRules{
      {{"kg m^2", "kg"}, {"N m", "N"}, {"rad", "m"}}};
  std::string unit(rotary_unit);
  for (const auto& [rotary, linear] : kRules) replace_all(&unit, rotary, linear);
  return unit;
}

}  // namespace

JointAxes::JointAxes(std::vector<Axes> joints) : all_(joints.front()) {
  if (std::all_of(joints.begin(), joints.end(), [this](Axes one) { return one == all_; })) return;
  all_ = Axes::mixed;
  joints_ = std::move(joints);
}

std::string_view to_string(Axes axes) {
  return axes == Axes::rotary ? "rotary" : axes == Axes::linear ? "linear" : "mixed";
}

std::string unit_for(Axes axes, std::string_view rotary_unit) {
  std::string rotary(rotary_unit);
  if (axes == Axes::rotary) return rotary;
  std::string linear = linear_unit(rotary_unit);
  if (axes == Axes::linear || linear == rotary) return linear;
  return rotary + " or " + linear;
}

}  // namespace cablefit
