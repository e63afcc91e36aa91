// The "transmission" of a model file: cables or linear springs, with numbers.
#include <fmt/core.h>

#include <algorithm>
#include <functional>
#include <iterator>

#include "cablefit/base/quote.hpp"
#include "cablefit/model/file/parts.hpp"
#include "cablefit/model/json_reading.hpp"
#include "cablefit/model/rig/searched_radius.hpp"

namespace cablefit::model_file {
namespace {

/// A list of values, one per joint; a single value counts as a list of one.
Eigen::VectorXd read_per_joint(const JsonNode& node, std::string_view name, const std::string& unit,
                               Model* model) {
  const std::vector<JsonNode> values = node.is_array() ? node.items : std::vector<JsonNode>{node};
  const int n = model->rig.n_joints();
  if (values.size() != static_cast<std::size_t>(n)) {
    throw node.error(fmt::format("{} value(s), expected {}", values.size(), n),
                     "give one per joint");
  }
  Eigen::VectorXd result(n);
  for (int k = 0; k < n; ++k) {
    const JsonNode& value = values[static_cast<std::size_t>(k)];
    const std::string indexed = joint_parameter_name(name, k + 1, n);
    const Estimate estimate =
        read_strict_estimate(value, indexed, indexed, unit_for(model->rig.axes.of(k), unit));
    result[k] = estimate.value;
    model->elastic.push_back(estimate);
  }
  return result;
}

/// The order at which the law has as many coefficients as the file gives.
int order_of(const JsonNode& coefficients, const CableLaw& law) {
  const auto count = some_items(coefficients).size();
  for (int order = 1; order <= law.max_order; ++order) {
    if (static_cast<std::size_t>(law.n_coefficients(order)) == count) return order;
  }
  throw coefficients.error(fmt::format("{} coefficients of a {} cable", count, law.name),
                           fmt::format("it has {} at most", law.n_coefficients(law.max_order)));
}

void read_coefficients(const JsonNode& node, Cable* cable, Model* model) {
  cable->order = order_of(node, *cable->law);
  cable->coefficients.clear();
  for (const JsonNode& value : node.items) {
    const int j = static_cast<int>(cable->coefficients.size());
    const std::string name = coefficient_name(*cable, j, model->rig.cables_given);
    model->elastic.push_back(
        read_strict_estimate(value, name, name,
                             unit_for(axes_of(model->rig.axes, *cable),
                                      coefficient_unit(*cable->law, j, model->rig.cables_given))));
    cable->coefficients.push_back(model->elastic.back().value);
  }
}

/// The rig's toe stands unless the file gives its own.
void read_toe(const JsonNode& node, Cable* cable) {
  const JsonNode* toe = node.find("toe");
  if (toe && !cable->law->has_toe) {
    throw toe->error(fmt::format("a {} cable has no toe", cable->law->name), "drop it");
  }
  if (toe) cable->toe = toe->positive();
  if (cable->law->has_toe && !(cable->toe > 0)) {
    throw node.error(fmt::format("a {} cable needs a toe", cable->law->name),
                     "give \"toe\", the elongation in m from which it is linear");
  }
  if (!cable->law->has_toe) cable->toe = 0;
}

void read_cable(const JsonNode& node, Cable* cable, Model* model) {
  node.allow_only({"name", "law", "toe", "coefficients", "l_o"});
  if (const JsonNode* law = node.find("law")) {
    cable->law = at_place_of(*law, [&] { return &find_cable_law(law->text()); });
  }
  read_toe(node, cable);
  read_coefficients(node.at("coefficients"), cable, model);
}

/// Elongations stand after all coefficients in `elastic`; a bare number is no estimate.
void read_elongation(const JsonNode& node, Cable* cable, Model* model) {
  const JsonNode* l_o = node.find("l_o");
  if (!l_o) return;
  const std::string name = elongation_name(*cable);
  const Estimate estimate =
      read_strict_estimate(*l_o, name, name, elongation_unit(model->rig.cables_given));
  cable->initial_elongation = estimate.value;
  if (l_o->is_object()) model->elastic.push_back(estimate);
}

const JsonNode& cable_named(const JsonNode& list, const std::string& name) {
  for (const JsonNode& item : some_items(list)) {
    if (item.at("name").text() == name) return item;
  }
  throw list.error(fmt::format("cable {} of the rig is missing", in_quotes(name)),
                   "give one entry per cable of the rig, by its name");
}

bool is_listed(const JsonNode& list, const Cable& cable) {
  const std::vector<JsonNode>& items = some_items(list);
  return std::any_of(items.begin(), items.end(),
                     [&](const JsonNode& item) { return item.at("name").text() == cable.name; });
}

void read_cables(const JsonNode& list, Model* model) {
  std::vector<Cable>& cables = model->transmission.cables;
  // refine leaves out a cable of a plain pair that the logs do not load.
  const auto has_entry = [&](const Cable& cable) { return is_listed(list, cable); };
  if (!model->rig.cables_given && some_items(list).size() < cables.size() &&
      std::any_of(cables.begin(), cables.end(), has_entry)) {
    std::copy_if(cables.begin(), cables.end(), std::back_inserter(model->transmission.idle_cables),
                 std::not_fn(has_entry));
    std::erase_if(cables, std::not_fn(has_entry));
  }
  for (Cable& cable : cables) read_cable(cable_named(list, cable.name), &cable, model);
  for (Cable& cable : cables) read_elongation(cable_named(list, cable.name), &cable, model);
  if (list.items.size() != cables.size()) {
    throw list.error(fmt::format("{} cables", list.items.size()),
                     fmt::format("the rig has {}", cables.size()));
  }
}

}  // namespace

void read_transmission(const JsonNode& node, Model* model) {
  node.allow_only({"linear", "cables", "theta_0"});
  model->transmission = model->rig.transmission;
  if (searches_radius(model->transmission)) {
    throw node.error("the rig of this model searches a motor radius",
                     "give \"motor_radius\" in m: a model knows it");
  }
  const JsonNode* linear = node.find("linear");
  if (linear && node.find("cables")) {
    throw node.error("both \"linear\" and \"cables\"", "keep one of them");
  }
  if (linear) {
    model->transmission = classical_spring(model->transmission);
    model->transmission.linear_stiffness = read_per_joint(*linear, "K", "N m/rad", model);
  } else {
    read_cables(node.at("cables"), model);
  }
  const JsonNode* theta_0 = node.find("theta_0");
  if (!theta_0) return;
  const auto without_zero = model->elastic.size();
  model->transmission.theta_0 = read_per_joint(*theta_0, "theta_0", "rad", model);
  const JsonNode& first = theta_0->is_array() ? theta_0->items.front() : *theta_0;
  if (!first.is_object()) model->elastic.resize(without_zero);
}

}  // namespace cablefit::model_file
