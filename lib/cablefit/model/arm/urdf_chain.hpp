// The chain of joints that a rig has, cut out of the tree of a URDF.
#pragma once

#include <string>
#include <vector>

#include "cablefit/model/arm/urdf_tree.hpp"

namespace cablefit {

/// Moving joints (types revolute, continuous, prismatic) on the way from one link to another.
/// Fixed joints are worked in.
struct UrdfWay {
  std::size_t base = 0, tip = 0;    ///< links
  std::vector<std::size_t> joints;  ///< all of them, from the base to the tip
};

/// Index of the link; throws Error(input) with a suggestion, without a place.
std::size_t find_link(const UrdfTree& tree, const std::string& name);
/// The link behind which no joint moves any more. Throws Error(input) when there is none or when
/// there are several.
std::size_t only_tip(const UrdfTree& tree, std::size_t base);
/// Throws Error(input) when `tip` does not hang on `base`, or on the way a joint mimics another or
/// moves in a way that is neither turning nor sliding.
UrdfWay way_between(const UrdfTree& tree, std::size_t base, std::size_t tip);
/// Those of `way.joints` that move.
std::vector<std::size_t> moving_joints(const UrdfTree& tree, const UrdfWay& way);

/// The joints and, on each, the inertia of all that hangs on it before the next: links on fixed
/// joints, and branches, at the zero of their joints. Without `rig_joint`, `gravity` and `slides`.
SerialChain chain_of(const UrdfTree& tree, const UrdfWay& way);

}  // namespace cablefit
