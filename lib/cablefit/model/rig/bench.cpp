// "load", "arm", "controller" and "cad": what stands around the transmission.
#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "cablefit/model/effects.hpp"
#include "cablefit/model/json_reading.hpp"
#include "cablefit/model/rig/parts.hpp"
#include "cablefit/model/rig/searched_radius.hpp"

namespace cablefit::rig_parts {
namespace {

/// Every parameter that a fit of this rig can give: of the effects, the spring and the cables.
std::vector<std::string> parameter_names(const Rig& rig) {
  std::vector<std::string> names{"K"};
  for (const Effect& effect : base_effects()) {
    for (const ParameterInfo& parameter : effect.parameters) names.emplace_back(parameter.name);
  }
  for (const ParameterInfo& parameter : rig.arm.base_parameters())
    names.emplace_back(parameter.name);
  for (const Cable& cable : rig.transmission.cables) {
    for (int j = 0; j < cable.n_coefficients(); ++j) {
      names.push_back(coefficient_name(cable, j, rig.cables_given));
    }
    names.push_back(elongation_name(cable));
    names.push_back(radius_name(cable));
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

Load read_load(const JsonNode& node, int n_joints, Axes axes) {
  const JsonNode& type = node.at("type");
  Load load;
  load.law = at_place_of(type, [&] { return &find_load_law(type.text()); });
  load.parameters = load.law->read(node);
  if (n_joints > 1 && !load.law->any_joints) {
    throw type.error(fmt::format("load '{}' on a rig of {} joints", load.law->name, n_joints),
                     "log tau_load1, tau_load2, ... and use {\"type\": \"column\"}");
  }
  if (axes != Axes::rotary && load.law->rotary_only) {
    throw type.error(fmt::format("load '{}' on a linear axis", load.law->name),
                     "its weight is a force: use {\"type\": \"constant\", \"torque\": N}");
  }
  return load;
}

Arm read_arm(const JsonNode& node, const Rig& rig) {
  const JsonNode& type = node.at("type");
  Arm arm;
  arm.kind = at_place_of(type, [&] { return &find_arm_kind(type.text()); });
  if (rig.axes.all() != Axes::rotary && arm.is_coupled() && !arm.kind->may_slide)
    throw type.error(fmt::format("arm '{}' with joints that slide", arm.kind->name),
                     "its joints turn: leave out \"motion\", or describe the arm as \"serial\"");
  arm.parameters = arm.kind->read(node, {rig.n_joints(), rig.axes});
  if (!arm.kind->becomes.empty()) arm.kind = &find_arm_kind(arm.kind->becomes);
  return arm;
}

namespace {

double gain(const JsonNode& node, std::string_view name) {
  const JsonNode* found = node.find(name);
  return found == nullptr ? 0 : not_negative(*found);
}

/// Gains of either sign: what a fit found.
void read_feedforward(const JsonNode& node, Controller& controller) {
  const JsonNode* feed = node.find("feedforward");
  if (feed == nullptr) return;
  feed->allow_only({"position", "velocity", "acceleration"});
  const auto read = [&](const char* name, double& to) {
    if (const JsonNode* value = feed->find(name)) to += value->number();
  };
  read("position", controller.feed_position);
  read("velocity", controller.feed_velocity);
  read("acceleration", controller.feed_acceleration);
}

/// kv ((v - dtheta/dt) + ki integral of it), v = kp e + c dref/dt, as one law in e and the
/// reference.
void read_cascade(const JsonNode& node, Controller& controller) {
  const double kp = not_negative(node.at("kp")), kv = not_negative(node.at("kv"));
  const double ki = gain(node, "ki"), fed = gain(node, "velocity_share");
  controller.kp = kv * (kp + ki);
  controller.ki = kv * ki * kp;
  controller.kd = kv;
  controller.feed_velocity = kv * (fed - 1);
  controller.feed_position = kv * ki * (fed - 1);
}

/// One controller; none: "open_loop".
std::optional<Controller> read_gains(const JsonNode& node) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kTypes{
      {{"pd", "pd"}, {"pid", "pid"}, {"cascade", "cascade"}, {"open_loop", "open_loop"}}};
  Controller controller;
  if (const JsonNode* type = node.find("type")) controller.type = choose(*type, kTypes);
  if (controller.type == "open_loop") {
    node.allow_only({"type"});
    return std::nullopt;
  }
  node.allow_only({"type", "kp", "kd", "ki", "kv", "velocity_share", "feedforward", "limit",
                   "period", "reference"});
  if (controller.type == "cascade") {
    node.allow_only({"type", "kp", "kv", "ki", "velocity_share", "feedforward", "limit", "period",
                     "reference"});
    read_cascade(node, controller);
  } else if (controller.type == "pid") {
    node.allow_only({"type", "kp", "ki", "kd", "feedforward", "limit", "period", "reference"});
    controller.kp = not_negative(node.at("kp"));
    controller.ki = gain(node, "ki");
    controller.kd = gain(node, "kd");
  } else {
    node.allow_only({"type", "kp", "kd", "limit", "period", "reference"});
    controller.kp = not_negative(node.at("kp"));
    controller.kd = gain(node, "kd");
  }
  if (controller.type != "pd") read_feedforward(node, controller);
  if (const JsonNode* limit = node.find("limit")) controller.limit = limit->positive();
  if (const JsonNode* period = node.find("period")) controller.period = period->positive();
  controller.reference = text_or(node, "reference", controller.reference);
  return controller;
}

/// The law of one of several joints.
Controller read_joint_gains(const JsonNode& node) {
  if (const auto law = read_gains(node)) return *law;
  throw node.error("\"open_loop\" for one joint only",
                   "give {\"type\": \"open_loop\"} without a list: it holds for all joints");
}

}  // namespace

std::optional<Controller> read_controller(const JsonNode& node, int n_joints) {
  if (!node.is_array()) return read_gains(node);
  if (node.items.size() != static_cast<std::size_t>(n_joints))
    throw node.error(fmt::format("{} controller(s), expected {}", node.items.size(), n_joints),
                     "give one per joint, or one for all joints without a list");
  std::vector<Controller> laws;
  for (const JsonNode& item : node.items) {
    laws.push_back(read_joint_gains(item));
    if (laws.back().period != laws.front().period ||
        laws.back().reference != laws.front().reference)
      throw item.error("\"period\" or \"reference\" differs from that of the first joint",
                       "give all joints the same; columns of the reference are numbered by joint");
  }
  return controller_of(std::move(laws));
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
