#include "cablefit/model/arm/kinds.hpp"
#include "cablefit/model/json_reading.hpp"

namespace cablefit::arms {
namespace {

ArmParameters read(const JsonNode& node, const RigJoints& joints) {
  node.allow_only({"type", "J_link"});
  ArmParameters parameters;
  const JsonNode* given = node.find("J_link");
  if (given == nullptr) return parameters;
  parameters.J_link = n_numbers(*given, joints.count);
  for (const double inertia : parameters.J_link)
    if (!(inertia > 0)) throw given->error("an inertia is not positive", "give kg m^2, above 0");
  return parameters;
}

std::vector<ArmEntry> entries(const ArmParameters& p) {
  if (p.J_link.empty()) return {};
  return {{"J_link", p.J_link}};
}

std::vector<ParameterInfo> base_parameters(const ArmParameters& /*parameters*/) { return {}; }

}  // namespace

ArmKind independent() {
  return {.name = "independent",
          .equation = "J_link[j] qdd_j, J_link estimated or given",
          .source = "Fichera & Grossard 2017, (14a)",
          .read = read,
          .entries = entries,
          .base_parameters = base_parameters,
          .regressor = nullptr};
}

}  // namespace cablefit::arms
