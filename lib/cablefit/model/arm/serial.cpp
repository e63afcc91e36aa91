// A chain of joints given by numbers. What a URDF is read into, so that model files stand for
// themselves: neither the URDF nor a program that can read one is needed again.
#include <fmt/core.h>

#include <algorithm>
#include <numeric>

#include "cablefit/model/arm/kinds.hpp"
#include "cablefit/model/arm/serial_arm.hpp"
#include "cablefit/model/json_reading.hpp"
#include "cablefit/model/load.hpp"

namespace cablefit::arms {
namespace {

using Rows = std::vector<std::vector<double>>;

/// One list of `width` numbers per joint.
Rows rows_at(const JsonNode& node, std::size_t n_joints, std::size_t width) {
  if (!node.is_array() || node.items.size() != n_joints)
    throw node.error("not one entry per joint of the rig",
                     fmt::format("give {} lists of {} numbers", n_joints, width));
  Rows rows;
  for (const JsonNode& item : node.items) {
    rows.push_back(item.numbers());
    if (rows.back().size() != width)
      throw item.error(fmt::format("{} number(s), expected {}", rows.back().size(), width), "");
  }
  return rows;
}

Eigen::Vector3d vector_of(const std::vector<double>& v) { return {v[0], v[1], v[2]}; }

std::vector<int> order_at(const JsonNode* node, std::size_t n_joints) {
  std::vector<int> order(n_joints);
  std::iota(order.begin(), order.end(), 0);
  if (node == nullptr) return order;
  const std::vector<double> given = n_numbers(*node, static_cast<int>(n_joints));
  for (std::size_t i = 0; i < n_joints; ++i) {
    const auto at = std::find(given.begin(), given.end(), static_cast<double>(i + 1));
    if (at == given.end())
      throw node->error(fmt::format("joint {} of the rig is missing", i + 1),
                        "name each joint of the rig once, from the base to the tip");
    order[static_cast<std::size_t>(at - given.begin())] = static_cast<int>(i);
  }
  return order;
}

void read_inertias(const JsonNode& node, SerialChain& chain) {
  const Rows rows = rows_at(node, chain.joints.size(), kLinkParameters);
  for (std::size_t i = 0; i < rows.size(); ++i)
    chain.joints[i].inertia = Eigen::Map<const LinkInertia>(rows[i].data());
}

ArmParameters read(const JsonNode& node, const RigJoints& joints) {
  node.allow_only({"type", "origins", "rpy", "axes", "gravity", "order", "inertias"});
  const auto n = static_cast<std::size_t>(joints.count);
  SerialChain chain;
  const Rows origins = rows_at(node.at("origins"), n, 3);
  const JsonNode* rpy = node.find("rpy");
  const Rows angles = rpy == nullptr ? Rows(n, {0, 0, 0}) : rows_at(*rpy, n, 3);
  const Rows axes = rows_at(node.at("axes"), n, 3);
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d axis = vector_of(axes[i]);
    if (axis.isZero(0))
      throw node.at("axes").items[i].error("an axis of length 0",
                                           "give the direction of the joint's axis");
    chain.joints.push_back(
        {vector_of(origins[i]), vector_of(angles[i]), unit_axis(axis), false, LinkInertia::Zero()});
  }
  chain.rig_joint = order_at(node.find("order"), n);
  for (std::size_t i = 0; i < n; ++i)
    chain.joints[i].slides = joints.axes.of(chain.rig_joint[i]) == Axes::linear;
  chain.gravity = gravity_at(node);
  if (const JsonNode* inertias = node.find("inertias")) read_inertias(*inertias, chain);
  ArmParameters parameters;
  parameters.serial = at_place_of(node, [&] { return serial_arm_of(std::move(chain)); });
  return parameters;
}

template <typename Vector>
std::vector<double> numbers_of(const Vector& v) {
  return {v.data(), v.data() + v.size()};
}

std::vector<ArmEntry> entries(const ArmParameters& p) {
  const SerialChain& chain = p.serial->chain;
  Rows origins, angles, axes, inertias;
  std::vector<double> order;
  for (const ChainJoint& joint : chain.joints) {
    origins.push_back(numbers_of(joint.origin));
    angles.push_back(numbers_of(joint.rpy));
    axes.push_back(numbers_of(joint.axis));
    inertias.push_back(numbers_of(joint.inertia));
  }
  for (const int joint : chain.rig_joint) order.push_back(joint + 1);
  std::vector<ArmEntry> all{{"origins", origins},
                            {"rpy", angles},
                            {"axes", axes},
                            {"gravity", numbers_of(chain.gravity)},
                            {"order", order}};
  if (chain.is_described()) all.push_back({"inertias", inertias});
  return all;
}

std::vector<ParameterInfo> base_parameters(const ArmParameters& p) {
  std::vector<ParameterInfo> all;
  for (const BaseParameter& base : p.serial->base)
    all.push_back({base.name, base.name, base.unit, base.combination, base.lower});
  return all;
}

void regressor(const ArmParameters& p, std::span<const Motion> links, int joint,
               Eigen::Ref<Eigen::MatrixXd> columns) {
  serial_regressor(p.serial->chain, links, joint, p.serial->kept, columns);
}

std::vector<double> described(const ArmParameters& p) {
  std::vector<double> values;
  if (!p.serial->chain.is_described()) return values;
  for (const BaseParameter& base : p.serial->base) values.push_back(base.value(p.serial->chain));
  return values;
}

SerialChain chain(const ArmParameters& p, std::span<const double> base) {
  SerialChain chain = p.serial->chain;
  for (ChainJoint& joint : chain.joints) joint.inertia.setZero();
  for (std::size_t k = 0; k < base.size(); ++k) {
    const Eigen::Index kept = p.serial->kept[k];
    chain.joints[static_cast<std::size_t>(kept / kLinkParameters)].inertia(kept % kLinkParameters) =
        base[k];
  }
  return chain;
}

}  // namespace

Eigen::Vector3d gravity_at(const JsonNode& node) {
  const JsonNode* gravity = node.find("gravity");
  if (gravity == nullptr) return {0, 0, -kGravity};
  const std::vector<double> g = gravity->numbers();
  if (g.size() != 3)
    throw gravity->error(fmt::format("{} number(s), expected 3", g.size()),
                         "give x, y and z in the frame of the base, m/s^2");
  return vector_of(g);
}

ArmKind serial() {
  return {.name = "serial",
          .equation = "M(q) qdd + C(q, qd) + g(q) of a chain of joints, by base parameters",
          .source = "Gautier & Khalil 1990; Gautier 1991",
          .read = read,
          .entries = entries,
          .base_parameters = base_parameters,
          .regressor = regressor,
          .described = described,
          .chain = chain,
          .may_slide = true};
}

}  // namespace cablefit::arms
