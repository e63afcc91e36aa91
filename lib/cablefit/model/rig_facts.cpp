#include "cablefit/model/rig_facts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <variant>

namespace cablefit {
namespace {

void add_column(const Rig& rig, const std::string& channel, RigFacts& facts) {
  const auto mapped = rig.columns.find(channel);
  const ColumnMapping mapping = mapped == rig.columns.end() ? ColumnMapping{} : mapped->second;
  facts.push_back({channel + " scale", fmt::format("{}", mapping.scale)});
  facts.push_back({channel + " shift", fmt::format("{}", mapping.shift)});
  facts.push_back({channel + " unit", mapping.unit.empty() ? "of the log" : mapping.unit});
}

std::string numbers_text(double value) { return fmt::format(" {}", value); }

template <typename Value>
std::string numbers_text(const std::vector<Value>& values) {
  std::string text;
  for (const Value& value : values) text += numbers_text(value);
  return text;
}

template <typename Map>
std::string map_text(const Map& map) {
  std::string text(map.kind->name);
  for (const auto& [key, value] : map.kind->entries(map.parameters))
    text += std::visit([](const auto& v) { return numbers_text(v); }, value);
  return text;
}

void add_pairs(const std::string& name, const std::vector<PairMap>& pairs, RigFacts& facts) {
  for (const PairMap& pair : pairs)
    facts.push_back(
        {fmt::format("{} {} {}", name, pair.joints[0] + 1, pair.joints[1] + 1), map_text(pair)});
}

void add_cable(const Cable& cable, RigFacts& facts) {
  const std::string name = "cable " + cable.name;
  facts.push_back({name + " law", std::string(cable.law->name)});
  for (std::size_t k = 0; k < cable.motor_map.size(); ++k) {
    const std::string joint = cable.motor_map.size() == 1 ? "" : fmt::format(" {}", k + 1);
    facts.push_back({name + " motor_radius" + joint, map_text(cable.motor_map[k])});
    facts.push_back({name + " link_radius" + joint, map_text(cable.link_map[k])});
  }
  add_pairs(name + " motor_map", cable.motor_pairs, facts);
  add_pairs(name + " link_map", cable.link_pairs, facts);
}

}  // namespace

RigFacts elastic_facts(const Rig& rig) {
  RigFacts facts = {{"motion", std::string(to_string(rig.axes.all()))},
                    {"number of joints", std::to_string(rig.n_joints())}};
  if (rig.axes.all() == Axes::mixed)
    for (int joint = 0; joint < rig.n_joints(); ++joint)
      facts.push_back({fmt::format("motion of joint {}", joint + 1),
                       std::string(to_string(rig.axes.of(joint)))});
  const bool one = rig.n_joints() == 1;
  for (const std::string channel : {"q", "theta", "tau"})
    for (int joint = 0; joint < rig.n_joints(); ++joint)
      add_column(rig, one ? channel : channel + std::to_string(joint + 1), facts);
  facts.push_back({"number of cables", std::to_string(rig.transmission.cables.size())});
  for (const Cable& cable : rig.transmission.cables) add_cable(cable, facts);
  return facts;
}

std::string changed_fact(const RigFacts& before, const RigFacts& now) {
  for (const RigFact& fact : before) {
    const auto other =
        std::find_if(now.begin(), now.end(), [&](const RigFact& f) { return f.name == fact.name; });
    if (other != now.end() && other->value != fact.value)
      return fmt::format("with {} {}, the rig now says {}", fact.name, fact.value, other->value);
  }
  return "";
}

}  // namespace cablefit
