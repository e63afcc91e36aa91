#include "cablefit/model/load/laws.hpp"

namespace cablefit::laws {
namespace {

LoadParameters read(const JsonNode& node) {
  node.allow_only({"type", "torque"});
  LoadParameters parameters;
  parameters.torque = node.at("torque").number();
  return parameters;
}

std::vector<LoadEntry> entries(const LoadParameters& parameters) {
  return {{"torque", parameters.torque}};
}

double torque(const LoadParameters& parameters, double /*q*/) { return parameters.torque; }

double inertia(const LoadParameters& /*parameters*/) { return 0.0; }

}  // namespace

LoadLaw constant() {
  return {.name = "constant",
          .equation = "tau_load = torque",
          .from_column = false,
          .read = read,
          .entries = entries,
          .torque = torque,
          .inertia = inertia,
          .any_joints = false,
          .rotary_only = false,
          .free_fall = nullptr};
}

}  // namespace cablefit::laws
