#include <cmath>

#include "cablefit/model/load/laws.hpp"

namespace cablefit::laws {
namespace {

LoadParameters read(const JsonNode& node) {
  node.allow_only({"type", "mass", "radius", "direction"});
  LoadParameters parameters;
  parameters.mass = node.at("mass").positive();
  parameters.radius = node.at("radius").positive();
  if (const JsonNode* direction = node.find("direction")) {
    parameters.direction = direction->number();
    if (std::abs(parameters.direction) != 1.0) {
      throw direction->error("direction must be 1 or -1",
                             "1: the weight turns the link towards larger q");
    }
  }
  return parameters;
}

std::vector<LoadEntry> entries(const LoadParameters& p) {
  return {{"mass", p.mass}, {"radius", p.radius}, {"direction", p.direction}};
}

double torque(const LoadParameters& p, double /*q*/) {
  return p.direction * p.mass * kGravity * p.radius;
}

double inertia(const LoadParameters& p) { return p.mass * p.radius * p.radius; }

// A rope only pulls: the mass cannot be pushed down faster than it falls.
double free_fall(const LoadParameters& p) { return kGravity / p.radius; }

}  // namespace

LoadLaw hanging_mass() {
  return {.name = "hanging_mass",
          .equation = "tau_load = direction m g r",
          .from_column = false,
          .read = read,
          .entries = entries,
          .torque = torque,
          .inertia = inertia,
          .any_joints = false,
          .rotary_only = true,
          .free_fall = free_fall};
}

}  // namespace cablefit::laws
