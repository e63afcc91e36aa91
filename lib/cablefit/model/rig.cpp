#include "cablefit/model/rig.hpp"

#include <fmt/format.h>

#include <array>
#include <filesystem>

#include "cablefit/base/json/schemas.hpp"
#include "cablefit/model/json_reading.hpp"
#include "cablefit/model/rig/parts.hpp"

namespace cablefit {
namespace {

constexpr std::array<std::pair<std::string_view, Axes>, 2> kMotions{
    {{"rotary", Axes::rotary}, {"linear", Axes::linear}}};
constexpr std::array<std::pair<std::string_view, TorqueHold>, 3> kHolds{
    {{"auto", TorqueHold::automatic}, {"zoh", TorqueHold::zoh}, {"none", TorqueHold::none}}};

/// One antagonist pair per joint in joint space: what a rig has when its file names no cables.
void set_default_cables(Rig* rig) {
  rig->transmission = antagonist_pairs(rig->n_joints(), kDefaultOrder);
  rig->search_elongation.assign(rig->transmission.cables.size(), false);
}

void read_torque_hold(const JsonNode& node, Rig* rig) {
  if (const JsonNode* hold = node.find("torque_hold")) rig->torque_hold = choose(*hold, kHolds);
  const JsonNode* period = node.find("torque_period");
  if (!period) return;
  rig->torque_period = period->positive();
  if (rig->torque_hold == TorqueHold::none) {
    throw period->error("torque_period without a hold", "use \"torque_hold\": \"zoh\" or drop it");
  }
}

/// One motion for all joints, or a list with one for each.
JointAxes read_motion(const JsonNode* node, std::size_t n_joints) {
  if (!node) return JointAxes(std::vector<Axes>(n_joints, Axes::rotary));
  if (!node->is_array()) return JointAxes(std::vector<Axes>(n_joints, choose(*node, kMotions)));
  if (node->items.size() != n_joints)
    throw node->error(fmt::format("{} motion(s), expected {}", node->items.size(), n_joints),
                      "give one per joint");
  std::vector<Axes> axes;
  for (const JsonNode& item : node->items) axes.push_back(choose(item, kMotions));
  return JointAxes(std::move(axes));
}

}  // namespace

Axes axes_of(const JointAxes& joints, const Cable& cable) {
  int joint = 0;
  while (!cable.passes(static_cast<std::size_t>(joint))) ++joint;
  return joints.of(joint);
}

Controller controller_of(std::vector<Controller> joints) {
  Controller all = joints.front();
  if (joints.size() > 1) all.joints = std::move(joints);
  return all;
}

Rig default_rig() {
  Rig rig;
  set_default_cables(&rig);
  return rig;
}

Rig parse_rig(const JsonNode& node) {
  node.allow_only({"schema", "name", "preload", "columns", "sample_rate", "motion", "torque_hold",
                   "torque_period", "load", "controller", "sensors", "cad", "joints", "cables",
                   "reference_pose", "arm"});
  check_schema(node, kRigSchema);
  Rig rig;
  rig.path = node.place.file;
  rig.name = text_or(node, "name", "");
  rig.preload = text_or(node, "preload", "");
  if (const JsonNode* rate = node.find("sample_rate")) rig.sample_rate = rate->positive();
  read_torque_hold(node, &rig);

  if (const JsonNode* joints = node.find("joints")) rig.joints = rig_parts::read_joints(*joints);
  rig.axes = read_motion(node.find("motion"), rig.joints.size());
  set_default_cables(&rig);
  if (const JsonNode* cables = node.find("cables")) rig_parts::read_cables(*cables, &rig);

  const int n = rig.n_joints();
  if (const JsonNode* pose = node.find("reference_pose")) {
    set_reference(rig.transmission, rig_parts::read_reference(*pose, n));
  }
  if (const JsonNode* columns = node.find("columns")) {
    rig.columns = rig_parts::read_columns(*columns, n);
  }
  if (const JsonNode* load = node.find("load")) {
    rig.load = rig_parts::read_load(*load, n, rig.axes.all());
  }
  if (const JsonNode* arm = node.find("arm")) rig.arm = rig_parts::read_arm(*arm, rig);
  if (const JsonNode* controller = node.find("controller")) {
    rig.controller = rig_parts::read_controller(*controller, n);
    rig.open_loop = !rig.controller;
  }
  if (const JsonNode* sensors = node.find("sensors")) {
    rig.sensors = rig_parts::read_sensors(*sensors, n);
  }
  if (const JsonNode* cad = node.find("cad")) rig.cad = rig_parts::read_cad(*cad, rig);
  rig_parts::add_described(&rig);
  return rig;
}

Rig read_rig(const std::string& path) { return parse_rig(read_json_file(path)); }

Rig rig_for_log(const std::string& log_path, const std::string& rig_option) {
  if (!rig_option.empty()) return read_rig(rig_option);
  const auto beside = std::filesystem::path(log_path).parent_path() / "rig.json";
  std::error_code ignored;
  return std::filesystem::exists(beside, ignored) ? read_rig(beside.string()) : default_rig();
}

}  // namespace cablefit
