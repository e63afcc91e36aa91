#include "cablefit/model/load/laws.hpp"

namespace cablefit::laws {
namespace {

LoadParameters read(const JsonNode& node) {
  node.allow_only({"type"});
  return {};
}

std::vector<LoadEntry> entries(const LoadParameters& /*parameters*/) { return {}; }

double torque(const LoadParameters& /*parameters*/, double /*q*/) { return 0.0; }

double inertia(const LoadParameters& /*parameters*/) { return 0.0; }

}  // namespace

LoadLaw column() {
  return {.name = "column",
          .equation = "tau_load(t), a column of the log",
          .from_column = true,
          .read = read,
          .entries = entries,
          .torque = torque,
          .inertia = inertia,
          .any_joints = true,
          .rotary_only = false,
          .free_fall = nullptr};
}

}  // namespace cablefit::laws
