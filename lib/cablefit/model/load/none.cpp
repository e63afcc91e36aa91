// Loads without a law of q: none at all, and a column of the log.
#include "cablefit/model/load/laws.hpp"

namespace cablefit::laws {
namespace {

LoadParameters read(const JsonNode& node) {
  node.allow_only({"type"});
  return {};
}

std::vector<LoadEntry> entries(const LoadParameters& /*parameters*/) { return {}; }

double zero(const LoadParameters& /*parameters*/, double /*q*/) { return 0.0; }

double inertia(const LoadParameters& /*parameters*/) { return 0.0; }

LoadLaw without_law(std::string_view name, std::string_view equation, bool from_column) {
  return {.name = name,
          .equation = equation,
          .from_column = from_column,
          .read = read,
          .entries = entries,
          .torque = zero,
          .inertia = inertia,
          .any_joints = true,
          .rotary_only = false,
          .free_fall = nullptr};
}

}  // namespace

LoadLaw none() { return without_law("none", "tau_load = 0", false); }

LoadLaw column() { return without_law("column", "tau_load(t), a column of the log", true); }

}  // namespace cablefit::laws
