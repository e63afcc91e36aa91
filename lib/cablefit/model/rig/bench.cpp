// "load", "arm", "controller" and "cad": what stands around the transmission.
#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "cablefit/model/effects.hpp"
#include "cablefit/model/json_reading.hpp"
#include "cablefit/model/rig/parts.hpp"

namespace cablefit::rig_parts {
namespace {

/// Every parameter that a fit of this rig can give: of the effects, the spring and the cables.
std::vector<std::string> parameter_names(const Rig& rig) {
  std::vector<std::string> names{"K"};
  for (const Effect& effect : effects()) {
    for (const ParameterInfo& parameter : effect.parameters) names.emplace_back(parameter.name);
  }
  for (const ParameterInfo& parameter : rig.arm.base_parameters())
    names.emplace_back(parameter.name);
  for (const Cable& cable : rig.transmission.cables) {
    for (int j = 0; j < cable.n_coefficients(); ++j) {
      names.push_back(coefficient_name(cable, j, rig.cables_given));
    }
    names.push_back(elongation_name(cable));
  }
  return names;
}

/// "J_motor[2]" is J_motor on a rig of two joints or more.
std::string without_joint_index(const std::string& name, int n_joints) {
  for (int joint = 1; n_joints > 1 && joint <= n_joints; ++joint) {
    const std::string index = fmt::format("[{}]", joint);
    if (name.ends_with(index)) return name.substr(0, name.size() - index.size());
  }
  return name;
}

}  // namespace

Load read_load(const JsonNode& node, int n_joints, bool linear_motion) {
  const JsonNode& type = node.at("type");
  Load load;
  load.law = at_place_of(type, [&] { return &find_load_law(type.text()); });
  load.parameters = load.law->read(node);
  if (n_joints > 1 && !load.law->any_joints) {
    throw type.error(fmt::format("load '{}' on a rig of {} joints", load.law->name, n_joints),
                     "log tau_load1, tau_load2, ... and use {\"type\": \"column\"}");
  }
  if (linear_motion && load.law->rotary_only) {
    throw type.error(fmt::format("load '{}' on a linear axis", load.law->name),
                     "its weight is a force: use {\"type\": \"constant\", \"torque\": N}");
  }
  return load;
}

Arm read_arm(const JsonNode& node, const Rig& rig) {
  const JsonNode& type = node.at("type");
  Arm arm;
  arm.kind = at_place_of(type, [&] { return &find_arm_kind(type.text()); });
  if (rig.linear_motion && arm.is_coupled() && !arm.kind->may_slide)
    throw type.error(fmt::format("arm '{}' on linear axes", arm.kind->name),
                     "its joints turn: leave out \"motion\": \"linear\"");
  arm.parameters = arm.kind->read(node, {rig.n_joints(), rig.linear_motion});
  if (!arm.kind->becomes.empty()) arm.kind = &find_arm_kind(arm.kind->becomes);
  return arm;
}

std::optional<Controller> read_controller(const JsonNode& node) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 2> kTypes{
      {{"pd", "pd"}, {"open_loop", "open_loop"}}};
  Controller controller;
  if (const JsonNode* type = node.find("type")) controller.type = choose(*type, kTypes);
  if (controller.type == "open_loop") {
    node.allow_only({"type"});
    return std::nullopt;
  }
  node.allow_only({"type", "kp", "kd", "limit", "period", "reference"});
  controller.kp = not_negative(node.at("kp"));
  if (const JsonNode* kd = node.find("kd")) controller.kd = not_negative(*kd);
  if (const JsonNode* limit = node.find("limit")) controller.limit = limit->positive();
  if (const JsonNode* period = node.find("period")) controller.period = period->positive();
  controller.reference = text_or(node, "reference", controller.reference);
  return controller;
}

std::map<std::string, double> read_cad(const JsonNode& node, const Rig& rig) {
  const std::vector<std::string> names = parameter_names(rig);
  const std::vector<std::string_view> known(names.begin(), names.end());
  std::map<std::string, double> cad;
  for (const auto& [name, value] : members_of(node)) {
    const bool is_known = std::find(known.begin(), known.end(), name) != known.end() ||
                          std::find(known.begin(), known.end(),
                                    without_joint_index(name, rig.n_joints())) != known.end();
    if (!is_known) fail_unknown(value, "parameter", name, known);
    cad[name] = value.number();
  }
  return cad;
}

void add_described(Rig* rig) {
  const std::vector<ParameterInfo> base = rig->arm.base_parameters();
  const std::vector<double> described = rig->arm.described();
  for (std::size_t k = 0; k < described.size(); ++k) rig->cad.emplace(base[k].name, described[k]);
}

}  // namespace cablefit::rig_parts
