// A serial arm as its URDF describes it. Read once: from then on it is a "serial" arm.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "cablefit/base/quote.hpp"
#include "cablefit/model/arm/kinds.hpp"
#include "cablefit/model/arm/serial_arm.hpp"
#include "cablefit/model/arm/urdf_chain.hpp"
#include "cablefit/model/arm/urdf_file.hpp"
#include "cablefit/model/json_reading.hpp"

namespace cablefit::arms {
namespace {

std::size_t link_at(const UrdfTree& tree, const JsonNode* node, std::size_t otherwise) {
  if (node == nullptr) return otherwise;
  return at_place_of(*node, [&] { return find_link(tree, node->text()); });
}

std::string listed(const UrdfTree& tree, const std::vector<std::size_t>& joints) {
  std::string names;
  for (const std::size_t j : joints) names += (names.empty() ? "" : ", ") + tree.joints[j].name;
  return shortened(names);
}

void require_fit(const JsonNode& node, const UrdfTree& tree, const std::vector<std::size_t>& moving,
                 const RigJoints& joints) {
  if (moving.size() != static_cast<std::size_t>(joints.count))
    throw node.error(fmt::format("the arm has {} moving joint(s) ({}), the rig {}", moving.size(),
                                 listed(tree, moving), joints.count),
                     "list them as the rig's \"joints\", or name another \"base\" or \"tip\"");
}

/// The rig file says which of its joints slide, as it gives the units of their columns.
void require_motion(const JsonNode& node, const UrdfTree& tree,
                    const std::vector<std::size_t>& moving, const std::vector<int>& places,
                    const JointAxes& axes) {
  for (std::size_t k = 0; k < moving.size(); ++k) {
    const UrdfJoint& joint = tree.joints[moving[k]];
    const bool slides = joint.motion == UrdfMotion::slides;
    if (slides == (axes.of(places[k]) == Axes::linear)) continue;
    throw node.error(
        fmt::format("joint {} {}, joint {} of the rig {}", in_quotes(joint.name),
                    slides ? "slides" : "turns", places[k] + 1, slides ? "turns" : "slides"),
        fmt::format("give \"motion\" in the rig file, of this joint \"{}\"",
                    slides ? "linear" : "rotary"));
  }
}

/// Of each moving joint: its place in the list of names, or else in the chain.
std::vector<int> rig_joints(const JsonNode* names, const UrdfTree& tree,
                            const std::vector<std::size_t>& moving) {
  const std::vector<std::string> given = names ? names->texts() : std::vector<std::string>{};
  std::vector<std::string_view> known;
  for (const std::size_t j : moving) known.push_back(tree.joints[j].name);
  if (names != nullptr && given.size() != moving.size())
    throw names->error(fmt::format("{} joint(s), the arm has {}", given.size(), moving.size()),
                       "name them all, in the rig's order");
  std::vector<int> places(moving.size());
  for (std::size_t k = 0; k < moving.size(); ++k) {
    const auto at = names ? std::find(known.begin(), known.end(), given[k])
                          : known.begin() + static_cast<std::ptrdiff_t>(k);
    if (at == known.end()) fail_unknown(names->items[k], "joint", given[k], known);
    if (names && std::find(given.begin(), given.begin() + static_cast<std::ptrdiff_t>(k),
                           given[k]) != given.begin() + static_cast<std::ptrdiff_t>(k))
      throw names->items[k].error(fmt::format("{} appears twice", in_quotes(given[k])),
                                  "name each joint once");
    places[static_cast<std::size_t>(at - known.begin())] = static_cast<int>(k);
  }
  return places;
}

ArmParameters read(const JsonNode& node, const RigJoints& joints) {
  node.allow_only({"type", "file", "base", "tip", "joints", "gravity"});
  const JsonNode& file = node.at("file");
  const auto beside = std::filesystem::path(node.place.file).parent_path() / file.text();
  const UrdfTree tree = at_place_of(file, [&] { return read_urdf(beside.string()); });
  const std::size_t base = link_at(tree, node.find("base"), tree.root);
  const JsonNode* named = node.find("tip");
  const JsonNode& place = named ? *named : file;
  const std::size_t tip =
      named ? link_at(tree, named, 0) : at_place_of(file, [&] { return only_tip(tree, base); });
  const UrdfWay way = at_place_of(place, [&] { return way_between(tree, base, tip); });
  const std::vector<std::size_t> moving = moving_joints(tree, way);
  require_fit(file, tree, moving, joints);
  SerialChain chain = chain_of(tree, way);
  chain.rig_joint = rig_joints(node.find("joints"), tree, moving);
  chain.gravity = gravity_at(node);
  require_motion(file, tree, moving, chain.rig_joint, joints.axes);
  ArmParameters parameters;
  parameters.serial = at_place_of(file, [&] { return serial_arm_of(std::move(chain)); });
  return parameters;
}

}  // namespace

ArmKind urdf() {
  ArmKind kind = serial();
  kind.name = "urdf";
  kind.equation = "the same, the chain read from a URDF file";
  kind.source = "http://wiki.ros.org/urdf/XML";
  kind.read = read;
  kind.becomes = "serial";
  return kind;
}

}  // namespace cablefit::arms
