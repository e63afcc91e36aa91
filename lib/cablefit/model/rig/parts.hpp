// The parts of a rig file, one reader per top-level key. Internal to rig.cpp.
#pragma once

#include "cablefit/base/axes.hpp"
#include "cablefit/base/json/json_document.hpp"
#include "cablefit/model/rig.hpp"

namespace cablefit::rig_parts {

/// "joints": the names, at least one.
std::vector<std::string> read_joints(const JsonNode& node);
/// "columns": a foreign column per channel, "q" or "q1" .. "qn".
std::map<std::string, ColumnMapping> read_columns(const JsonNode& node, int n_joints);
/// "cables": sets the transmission, `cables_given` and `search_elongation`; needs the joints.
void read_cables(const JsonNode& node, Rig* rig);
/// "reference_pose": where every l = l_o.
ReferencePose read_reference(const JsonNode& node, int n_joints);
/// "load": a law of q (one joint) or a column.
Load read_load(const JsonNode& node, int n_joints, Axes axes);
/// "arm": how the links move each other; needs the joints.
Arm read_arm(const JsonNode& node, const Rig& rig);
/// "controller", or a list with one for each joint; none is one of type "open_loop".
std::optional<Controller> read_controller(const JsonNode& node, int n_joints);
/// "sensors": resolution and noise per numeric channel.
std::map<std::string, SensorInfo> read_sensors(const JsonNode& node, int n_joints);
/// "cad": values by parameter name; needs the joints and cables, which name the parameters.
std::map<std::string, double> read_cad(const JsonNode& node, const Rig& rig);
/// What the arm's description gives, where "cad" does not.
void add_described(Rig* rig);

/// A channel of a log. Text channels have no unit, per-joint ones may carry an index.
struct ChannelName {
  std::string_view name;
  bool is_number;
  bool per_joint;
};

/// The row of a channel name with or without a joint index 1 .. n_joints; throws at `node`.
const ChannelName& channel_named(const std::string& name, int n_joints, const JsonNode& node);

}  // namespace cablefit::rig_parts
