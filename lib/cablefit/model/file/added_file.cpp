// "refinements" of a model file.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/base/quote.hpp"
#include "cablefit/model/effects/effect_parameter.hpp"
#include "cablefit/model/file/parts.hpp"
#include "cablefit/model/json_reading.hpp"

namespace cablefit::model_file {
namespace {

constexpr std::array<std::pair<std::string_view, Site>, 5> kSites{
    {{"link", Site::link},
     {"motor", Site::motor},
     {"transmission", Site::transmission},
     {"sensor", Site::sensor},
     {"drive", Site::drive}}};

Estimate read_parameter(const JsonNode& node, const ParameterInfo& info, Axes axes) {
  Estimate estimate =
      read_strict_estimate(node, std::string(info.name), info.symbol, unit_for(axes, info.unit));
  if (estimate.value >= info.lower && estimate.value <= info.upper) return estimate;
  const std::string range = std::isinf(info.upper)
                                ? fmt::format("at least {:g}", info.lower)
                                : fmt::format("from {:g} to {:g}", info.lower, info.upper);
  throw node.error(fmt::format("{} = {:g} {}", info.name, estimate.value, estimate.unit),
                   fmt::format("expected {}: {}", range, info.meaning));
}

Estimate left_out(const ParameterInfo& info, Axes axes) {
  Estimate estimate;
  estimate.name = info.name;
  estimate.symbol = info.symbol;
  estimate.unit = unit_for(axes, info.unit);
  estimate.value = 0;
  return estimate;
}

std::vector<Estimate> read_parameters(const JsonNode* node, const JsonNode& row_node,
                                      const Effect& row, Axes axes) {
  std::vector<Estimate> parameters;
  if (!node && row.parameters.empty()) return parameters;
  const JsonNode& values = node ? *node : row_node.at("parameters");
  std::vector<std::string_view> known;
  for (std::size_t p = 0; p < row.parameters.size(); ++p) {
    const ParameterInfo& info = row.parameters[p];
    known.push_back(info.name);
    if (may_be_left_out(row, p) && !values.find(info.name))
      parameters.push_back(left_out(info, axes));
    else
      parameters.push_back(read_parameter(values.at(info.name), info, axes));
  }
  for (const auto& [key, value] : members_of(values))
    if (std::find(known.begin(), known.end(), key) == known.end())
      fail_unknown(value, "parameter", key, known);
  return parameters;
}

void read_event(const JsonNode& node, EffectInstance& instance) {
  const JsonNode* event = node.find("event");
  if (!instance.effect->is_event) {
    if (!event) return;
    throw event->error(fmt::format("'{}' is not an event", instance.effect->name), "drop it");
  }
  const JsonNode& date = node.at("event");
  date.allow_only({"log", "time"});
  const double log = number_or(date, "log", 1);
  if (!(log >= 1) || log != std::floor(log) || log > 1e6)
    throw date.at("log").error("not the number of a log", "expected 1, 2, ...: in the order given");
  instance.event_log = static_cast<std::size_t>(log) - 1;
  instance.event_time = date.at("time").number();
}

EffectInstance read_refinement(const JsonNode& node, Axes axes, bool rigid) {
  const Site site = choose(node.at("side"), kSites);
  const JsonNode& name = node.at("name");
  EffectInstance instance;
  instance.effect = at_place_of(name, [&] { return &find_candidate(name.text(), site); });
  if (rigid && site == Site::transmission)
    throw name.error(fmt::format("{} on a rigid drive", in_quotes(name.text())),
                     "it has no transmission: drop it, or give link and motor");
  instance.parameters = read_parameters(node.find("parameters"), node, *instance.effect, axes);
  read_event(node, instance);
  return instance;
}

}  // namespace

std::vector<EffectInstance> read_refinements(const JsonNode& node, Axes axes, bool rigid) {
  std::vector<EffectInstance> refinements;
  for (const JsonNode& item : some_items(node)) {
    item.allow_only({"name", "side", "parameters", "event"});
    refinements.push_back(read_refinement(item, axes, rigid));
  }
  return refinements;
}

EffectsPerJoint read_effects_per_joint(const JsonNode& node, const Rig& rig, bool rigid) {
  EffectsPerJoint effects(static_cast<std::size_t>(rig.n_joints()));
  for (const JsonNode& item : some_items(node)) {
    item.allow_only({"name", "side", "joint", "parameters", "event"});
    const double joint =
        rig.n_joints() == 1 ? number_or(item, "joint", 1) : item.at("joint").number();
    if (!(joint >= 1) || joint != std::floor(joint) || joint > rig.n_joints())
      throw item.at("joint").error("not the number of a joint",
                                   fmt::format("expected 1 to {}", rig.n_joints()));
    const int at = static_cast<int>(joint) - 1;
    effects[static_cast<std::size_t>(at)].push_back(read_refinement(item, rig.axes.of(at), rigid));
  }
  return effects;
}

}  // namespace cablefit::model_file
