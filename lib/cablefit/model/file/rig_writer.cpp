#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "cablefit/model/file/controller_text.hpp"
#include "cablefit/model/file/writer.hpp"
#include "cablefit/model/rig/searched_radius.hpp"

namespace cablefit::model_file {
namespace {

using Json = nlohmann::ordered_json;

Json column_json(const ColumnMapping& mapping) {
  Json json{{"column", mapping.column}};
  if (mapping.scale != 1) json["scale"] = mapping.scale;
  if (mapping.shift != 0) json["shift"] = mapping.shift;
  if (!mapping.unit.empty()) json["unit"] = mapping.unit;
  return json;
}

Json load_json(const Load& load) {
  Json json{{"type", load.law->name}};
  for (const auto& [key, value] : load.law->entries(load.parameters)) {
    std::visit([&, name = std::string(key)](const auto& v) { json[name] = v; }, value);
  }
  return json;
}

Json law_json(const Controller& controller) {
  const bool is_pd = controller.type == "pd";
  Json json{{"type", is_pd ? "pd" : "pid"}, {"kp", controller.kp}, {"kd", controller.kd}};
  if (!is_pd) {  // a cascade is the same law in other words
    json["ki"] = controller.ki;
    json["feedforward"] = {{"position", controller.feed_position},
                           {"velocity", controller.feed_velocity},
                           {"acceleration", controller.feed_acceleration}};
  }
  if (std::isfinite(controller.limit)) json["limit"] = controller.limit;
  if (controller.period > 0) json["period"] = controller.period;
  json["reference"] = controller.reference;
  return json;
}

Json controller_json(const Controller& controller) {
  if (controller.joints.empty()) return law_json(controller);
  Json list = Json::array();
  for (const Controller& joint : controller.joints) list.push_back(law_json(joint));
  return list;
}

Json arm_json(const Arm& arm) {
  Json json{{"type", arm.kind->name}};
  for (const auto& [key, value] : arm.kind->entries(arm.parameters)) {
    std::visit([&, name = std::string(key)](const auto& v) { json[name] = v; }, value);
  }
  return json;
}

Json sensor_json(const SensorInfo& sensor) {
  Json json = Json::object();
  if (sensor.quantum) json["quantum"] = *sensor.quantum;
  if (sensor.noise) json["noise"] = *sensor.noise;
  return json;
}

Json vector_json(const Eigen::VectorXd& values) {
  return std::vector<double>(values.begin(), values.end());
}

Json map_json(const DisplacementMap& map) {
  if (is_searched(map)) return {{"search", map.radius(0)}};
  if (map.kind->constant_radius) return map.radius(0);
  Json json{{"type", map.kind->name}};
  for (const auto& [key, value] : map.kind->entries(map.parameters)) {
    std::visit([&, name = std::string(key)](const auto& v) { json[name] = v; }, value);
  }
  return json;
}

Json maps_json(const std::vector<DisplacementMap>& maps) {
  Json list = Json::array();
  for (const DisplacementMap& map : maps) list.push_back(map_json(map));
  return list;
}

Json pairs_json(const std::vector<PairMap>& pairs, const std::vector<std::string>& joints) {
  Json list = Json::array();
  for (const PairMap& pair : pairs) {
    Json json{{"type", pair.kind->name},
              {"joints", {joints[pair.joints[0]], joints[pair.joints[1]]}}};
    for (const auto& [key, value] : pair.kind->entries(pair.parameters))
      std::visit([&, name = std::string(key)](const auto& v) { json[name] = v; }, value);
    list.push_back(json);
  }
  return list;
}

Json cables_json(const Rig& rig) {
  Json list = Json::array();
  for (const Cable& cable : rig.transmission.cables) {
    Json json{{"name", cable.name},
              {"motor_radius", maps_json(cable.motor_map)},
              {"link_radius", maps_json(cable.link_map)},
              {"law", cable.law->name},
              {"order", cable.order}};
    if (!cable.motor_pairs.empty()) json["motor_map"] = pairs_json(cable.motor_pairs, rig.joints);
    if (!cable.link_pairs.empty()) json["link_map"] = pairs_json(cable.link_pairs, rig.joints);
    if (cable.law->has_toe) json["toe"] = cable.toe;
    if (!cable.coefficients.empty()) json["coefficients"] = cable.coefficients;
    if (rig.search_elongation[list.size()]) {
      json["initial_elongation"] = "search";
    } else {
      json["initial_elongation"] = cable.initial_elongation;
    }
    list.push_back(json);
  }
  return list;
}

std::string_view name_of(TorqueHold hold) {
  return hold == TorqueHold::zoh ? "zoh" : hold == TorqueHold::none ? "none" : "auto";
}

template <typename Map, typename ToJson>
void add_map(Json* json, const char* key, const Map& map, ToJson to_json) {
  for (const auto& [name, value] : map) (*json)[key][name] = to_json(value);
}

Json motion_json(const Rig& rig) {
  if (rig.axes.all() != Axes::mixed) return to_string(rig.axes.all());
  Json list = Json::array();
  for (int joint = 0; joint < rig.n_joints(); ++joint)
    list.push_back(to_string(rig.axes.of(joint)));
  return list;
}

}  // namespace

Json rig_json(const Rig& rig) {
  Json json = Json::object();
  if (!rig.name.empty()) json["name"] = rig.name;
  if (!rig.preload.empty()) json["preload"] = rig.preload;
  add_map(&json, "columns", rig.columns, column_json);
  if (rig.sample_rate > 0) json["sample_rate"] = rig.sample_rate;
  if (const Json motion = motion_json(rig); motion != "rotary") json["motion"] = motion;
  if (rig.torque_hold != TorqueHold::automatic) json["torque_hold"] = name_of(rig.torque_hold);
  if (rig.torque_period > 0) json["torque_period"] = rig.torque_period;
  if (rig.load.law) json["load"] = load_json(rig.load);
  if (rig.arm.kind) json["arm"] = arm_json(rig.arm);
  if (rig.controller) json["controller"] = controller_json(*rig.controller);
  if (rig.open_loop) json["controller"] = {{"type", "open_loop"}};
  add_map(&json, "sensors", rig.sensors, sensor_json);
  add_map(&json, "cad", rig.cad, [](double value) { return value; });
  if (rig.joints != Rig().joints) {
    for (const std::string& name : rig.joints) json["joints"].push_back({{"name", name}});
  }
  if (rig.cables_given) json["cables"] = cables_json(rig);
  const ReferencePose& pose = rig.transmission.reference;
  if (pose.q.size() > 0) {
    json["reference_pose"] = {{"q", vector_json(pose.q)}, {"theta", vector_json(pose.theta)}};
  }
  return json;
}

}  // namespace cablefit::model_file

namespace cablefit {

namespace {

/// With six digits of each gain: more are not known, and nobody wants to read them.
Controller rounded(Controller c) {
  for (double Controller::*gain :
       {&Controller::kp, &Controller::kd, &Controller::ki, &Controller::feed_position,
        &Controller::feed_velocity, &Controller::feed_acceleration})
    c.*gain = std::stod(fmt::format("{:.6g}", c.*gain));
  std::transform(c.joints.begin(), c.joints.end(), c.joints.begin(), rounded);
  return c;
}

}  // namespace

std::string controller_text(const Controller& controller) {
  // One entry a line, then on one line: with blanks where it may be broken.
  std::string text = model_file::controller_json(rounded(controller)).dump(0);
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

}  // namespace cablefit
