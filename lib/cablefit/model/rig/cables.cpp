// "joints" and "cables": the routing.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "cablefit/model/json_reading.hpp"
#include "cablefit/model/rig/parts.hpp"

namespace cablefit::rig_parts {
namespace {

Eigen::VectorXd read_radius(const JsonNode& node, int n_joints) {
  const std::vector<double> radius = n_numbers(node, n_joints);
  if (std::all_of(radius.begin(), radius.end(), [](double r) { return r == 0; })) {
    throw node.error("radius is 0", "give the signed radius in m, - where the motion slackens it");
  }
  return Eigen::Map<const Eigen::VectorXd>(radius.data(), n_joints);
}

int read_order(const JsonNode& cable, const CableLaw& law) {
  const JsonNode* node = cable.find("order");
  if (!node) return std::min(2, law.max_order);
  const double order = node->number();
  if (order != std::floor(order) || order < 1 || order > law.max_order) {
    throw node->error(fmt::format("order {} of a {} cable", order, law.name),
                      fmt::format("the order of the force is a whole number from 1 to {}; 1 is "
                                  "linear, 2 is K_0 l + K_1 l^2",
                                  law.max_order));
  }
  return static_cast<int>(order);
}

const CableLaw& read_law(const JsonNode& cable) {
  const JsonNode* node = cable.find("law");
  if (!node) return find_cable_law("polynomial");
  return at_place_of(*node, [&]() -> const CableLaw& { return find_cable_law(node->text()); });
}

/// "initial_elongation": a number (below 0: dead travel) or "search".
bool read_elongation(const JsonNode& cable, double* elongation) {
  const JsonNode* node = cable.find("initial_elongation");
  if (!node) return false;
  if (node->is_string()) {
    if (node->text() == "search") return true;
    throw node->error(fmt::format("unknown initial_elongation '{}'", node->text()),
                      "give a number in m, or \"search\" to estimate it");
  }
  *elongation = node->number();
  return false;
}

Cable read_cable(const JsonNode& node, int n_joints, bool* search) {
  node.allow_only({"name", "motor_radius", "link_radius", "law", "order", "initial_elongation"});
  Cable cable;
  cable.motor_radius = read_radius(node.at("motor_radius"), n_joints);
  cable.link_radius = read_radius(node.at("link_radius"), n_joints);
  cable.law = &read_law(node);
  cable.order = read_order(node, *cable.law);
  *search = read_elongation(node, &cable.initial_elongation);
  return cable;
}

}  // namespace

std::vector<std::string> read_joints(const JsonNode& node) {
  std::vector<std::string> joints;
  for (const JsonNode& joint : some_items(node)) {
    joint.allow_only({"name"});
    joints.push_back(unique_name(joint, joints));
  }
  return joints;
}

void read_cables(const JsonNode& node, Rig* rig) {
  rig->cables_given = true;
  rig->transmission.cables.clear();
  rig->search_elongation.clear();
  std::vector<std::string> names;
  for (const JsonNode& item : some_items(node)) {
    bool search = false;
    Cable cable = read_cable(item, rig->n_joints(), &search);
    cable.name = names.emplace_back(unique_name(item, names));
    rig->transmission.cables.push_back(std::move(cable));
    rig->search_elongation.push_back(search);
  }
}

}  // namespace cablefit::rig_parts
