// "columns" and "sensors": what is keyed by the name of a channel.
#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "cablefit/base/quote.hpp"
#include "cablefit/log/column_header.hpp"
#include "cablefit/model/json_reading.hpp"
#include "cablefit/model/rig/parts.hpp"

namespace cablefit::rig_parts {
namespace {

constexpr std::array<ChannelName, 10> kChannels{{{"t", true, false},
                                                 {"q", true, true},
                                                 {"theta", true, true},
                                                 {"tau", true, true},
                                                 {"tau_load", true, true},
                                                 {"w", true, true},
                                                 {"theta_ref", true, true},
                                                 {"preload", false, false},
                                                 {"phase", false, false},
                                                 {"run", false, false}}};

const ChannelName* find_channel(std::string_view name) {
  const auto found = std::find_if(kChannels.begin(), kChannels.end(),
                                  [&](const ChannelName& c) { return c.name == name; });
  return found == kChannels.end() ? nullptr : &*found;
}

[[noreturn]] void fail_unknown_channel(const std::string& name, const JsonNode& node) {
  std::array<std::string_view, kChannels.size()> known;
  std::transform(kChannels.begin(), kChannels.end(), known.begin(),
                 [](const ChannelName& c) { return c.name; });
  fail_unknown(node, "channel", name, known);
}

/// The header cell as written: "motor [deg]" is column motor in deg.
ColumnMapping split_header_cell(const JsonNode& node) {
  const ColumnHeader header = to_column_header(node.text(), node.place);
  if (header.name.empty()) throw node.error("empty column name", "name a column of the log");
  unit_at(node, header.unit);
  ColumnMapping mapping;
  mapping.column = header.name;
  mapping.unit = header.unit;
  return mapping;
}

ColumnMapping read_mapping(const JsonNode& node, const ChannelName& channel) {
  if (node.is_string()) return split_header_cell(node);
  node.allow_only({"column", "scale", "shift", "unit"});
  ColumnMapping mapping = split_header_cell(node.at("column"));
  if (!channel.is_number && node.members.size() > 1) {
    throw node.error(fmt::format("channel '{}' holds text", channel.name),
                     "give its column only, without scale, shift or unit");
  }
  mapping.scale = number_or(node, "scale", 1.0);
  if (mapping.scale == 0) {
    throw node.at("scale").error("scale is 0", "leave it out for 1; -1 reverses the sign");
  }
  mapping.shift = number_or(node, "shift", 0.0);
  if (const JsonNode* unit = node.find("unit")) {
    unit_at(*unit, unit->text());
    mapping.unit = unit->text();
  }
  return mapping;
}

SensorInfo read_sensor(const JsonNode& node) {
  node.allow_only({"quantum", "noise"});
  SensorInfo sensor;
  if (const JsonNode* quantum = node.find("quantum")) sensor.quantum = quantum->positive();
  if (const JsonNode* noise = node.find("noise")) sensor.noise = not_negative(*noise);
  return sensor;
}

}  // namespace

const ChannelName& channel_named(const std::string& name, int n_joints, const JsonNode& node) {
  if (const ChannelName* channel = find_channel(name)) return *channel;
  const auto digits = name.find_last_not_of("0123456789") + 1;
  const ChannelName* channel = find_channel(name.substr(0, digits));
  if (!channel || !channel->per_joint) fail_unknown_channel(name, node);
  for (int joint = 1; joint <= n_joints; ++joint) {
    if (name.substr(digits) == std::to_string(joint)) return *channel;
  }
  throw node.error(fmt::format("channel {} is not of this rig", in_quotes(name)),
                   fmt::format("its joints are numbered 1 to {}", n_joints));
}

std::map<std::string, ColumnMapping> read_columns(const JsonNode& node, int n_joints) {
  std::map<std::string, ColumnMapping> columns;
  for (const auto& [name, value] : members_of(node)) {
    columns[name] = read_mapping(value, channel_named(name, n_joints, value));
  }
  return columns;
}

std::map<std::string, SensorInfo> read_sensors(const JsonNode& node, int n_joints) {
  std::map<std::string, SensorInfo> sensors;
  for (const auto& [name, value] : members_of(node)) {
    const ChannelName& channel = channel_named(name, n_joints, value);
    if (!channel.is_number) {
      throw value.error(fmt::format("channel '{}' has no sensor", name), "it holds text");
    }
    sensors[name] = read_sensor(value);
  }
  return sensors;
}

}  // namespace cablefit::rig_parts
