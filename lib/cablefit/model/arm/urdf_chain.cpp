#include "cablefit/model/arm/urdf_chain.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cablefit/base/catalog.hpp"
#include "cablefit/base/error.hpp"
#include "cablefit/base/quote.hpp"

namespace cablefit {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

struct Frame {
  Matrix3d rotation = Matrix3d::Identity();
  Vector3d origin = Vector3d::Zero();
  Frame behind(const UrdfJoint& joint) const {
    return {rotation * rotation_of(joint.rpy), origin + rotation * joint.origin};
  }
};

bool moves(const UrdfJoint& joint) { return joint.motion != UrdfMotion::fixed; }

/// Ends of moving joints behind `link` behind which none moves.
void find_tips(const UrdfTree& tree, std::size_t link, std::vector<std::size_t>& tips) {
  for (const std::size_t j : tree.links[link].children) {
    const UrdfJoint& joint = tree.joints[j];
    const std::size_t before = tips.size();
    find_tips(tree, joint.child, tips);
    if (moves(joint) && tips.size() == before) tips.push_back(joint.child);
  }
}

/// The inertia of a link and of all that hangs on it, but not beyond the joint `beyond`.
LinkInertia hanging_on(const UrdfTree& tree, std::size_t link, std::ptrdiff_t beyond) {
  LinkInertia sum = tree.links[link].inertia;
  for (const std::size_t j : tree.links[link].children) {
    if (static_cast<std::ptrdiff_t>(j) == beyond) continue;
    const UrdfJoint& joint = tree.joints[j];
    sum += moved(hanging_on(tree, joint.child, beyond), rotation_of(joint.rpy), joint.origin);
  }
  return sum;
}

void require_simple(const UrdfTree& tree, const UrdfJoint& joint) {
  const Place place{tree.path, joint.line};
  if (!joint.mimics.empty())
    throw input_error(place, fmt::format("joint {} mimics another", in_quotes(joint.name)),
                      "only joints that move by themselves can be fitted");
  if (joint.motion == UrdfMotion::other)
    throw input_error(
        place, fmt::format("joint {} is of type {}", in_quotes(joint.name), in_quotes(joint.type)),
        "revolute, continuous, prismatic and fixed joints can be fitted");
}

}  // namespace

LinkInertia moved(const LinkInertia& body, const Matrix3d& rotation, const Vector3d& origin) {
  Matrix3d tensor;
  tensor << body(4), body(5), body(6), body(5), body(7), body(8), body(6), body(8), body(9);
  const double mass = body(0);
  const Vector3d moment = rotation * body.segment<3>(1);
  // Points at origin + x: |r|^2 E - r r' with r = origin + x, summed over the body.
  const Matrix3d mixed = origin * moment.transpose();
  const Matrix3d about =
      rotation * tensor * rotation.transpose() +
      (2 * origin.dot(moment) + mass * origin.squaredNorm()) * Matrix3d::Identity() - mixed -
      mixed.transpose() - mass * origin * origin.transpose();
  LinkInertia out;
  out << mass, moment + mass * origin, about(0, 0), about(0, 1), about(0, 2), about(1, 1),
      about(1, 2), about(2, 2);
  return out;
}

std::size_t find_link(const UrdfTree& tree, const std::string& name) {
  std::vector<std::string_view> known;
  for (std::size_t k = 0; k < tree.links.size(); ++k) {
    if (tree.links[k].name == name) return k;
    known.push_back(tree.links[k].name);
  }
  throw input_error({}, fmt::format("unknown link {}", in_quotes(name)), suggestion(name, known));
}

std::size_t only_tip(const UrdfTree& tree, std::size_t base) {
  std::vector<std::size_t> tips;
  find_tips(tree, base, tips);
  if (tips.empty())
    throw input_error({tree.path},
                      fmt::format("no joint moves after link {}", in_quotes(tree.links[base].name)),
                      "name another \"base\"");
  if (tips.size() == 1) return tips.front();
  std::string names;
  for (const std::size_t tip : tips) names += (names.empty() ? "" : ", ") + tree.links[tip].name;
  throw input_error({tree.path},
                    fmt::format("the tree branches, its ends are {}", shortened(names)),
                    "name the arm's \"tip\"");
}

UrdfWay way_between(const UrdfTree& tree, std::size_t base, std::size_t tip) {
  UrdfWay way{base, tip, {}};
  for (std::size_t link = tip; link != base;) {
    const std::ptrdiff_t joint = tree.links[link].joint;
    if (joint < 0)
      throw input_error(
          {tree.path},
          fmt::format("link {} does not descend from link {}", in_quotes(tree.links[tip].name),
                      in_quotes(tree.links[base].name)),
          "the base comes before the tip");
    way.joints.push_back(static_cast<std::size_t>(joint));
    link = tree.joints[way.joints.back()].parent;
    require_simple(tree, tree.joints[way.joints.back()]);
  }
  std::reverse(way.joints.begin(), way.joints.end());
  return way;
}

std::vector<std::size_t> moving_joints(const UrdfTree& tree, const UrdfWay& way) {
  std::vector<std::size_t> moving;
  std::copy_if(way.joints.begin(), way.joints.end(), std::back_inserter(moving),
               [&](std::size_t j) { return moves(tree.joints[j]); });
  return moving;
}

SerialChain chain_of(const UrdfTree& tree, const UrdfWay& way) {
  SerialChain chain;
  const std::vector<std::size_t> moving = moving_joints(tree, way);
  Frame frame;
  for (const std::size_t j : way.joints) {
    const UrdfJoint& joint = tree.joints[j];
    frame = frame.behind(joint);
    if (!moves(joint)) continue;
    const std::size_t i = chain.joints.size();
    const auto next = i + 1 < moving.size() ? static_cast<std::ptrdiff_t>(moving[i + 1]) : -1;
    chain.joints.push_back({frame.origin, rpy_of(frame.rotation), joint.axis,
                            joint.motion == UrdfMotion::slides,
                            hanging_on(tree, joint.child, next)});
    frame = {};
  }
  return chain;
}

}  // namespace cablefit
