#include <cmath>

#include "cablefit/model/load/laws.hpp"

namespace cablefit::laws {
namespace {

LoadParameters read(const JsonNode& node) {
  node.allow_only({"type", "mass", "length", "zero"});
  LoadParameters parameters;
  parameters.mass = node.at("mass").positive();
  parameters.length = node.at("length").positive();
  if (const JsonNode* zero = node.find("zero")) parameters.zero = zero->number();
  return parameters;
}

std::vector<LoadEntry> entries(const LoadParameters& p) {
  return {{"mass", p.mass}, {"length", p.length}, {"zero", p.zero}};
}

double torque(const LoadParameters& p, double q) {
  return -p.mass * kGravity * p.length * std::sin(q - p.zero);
}

double slope(const LoadParameters& p, double q) {
  return -p.mass * kGravity * p.length * std::cos(q - p.zero);
}

double inertia(const LoadParameters& p) { return p.mass * p.length * p.length; }

}  // namespace

LoadLaw pendulum() {
  return {.name = "pendulum",
          .equation = "tau_load = -m g L sin(q - zero)",
          .from_column = false,
          .read = read,
          .entries = entries,
          .torque = torque,
          .inertia = inertia,
          .any_joints = false,
          .rotary_only = true,
          .free_fall = nullptr,
          .slope = slope};
}

}  // namespace cablefit::laws
