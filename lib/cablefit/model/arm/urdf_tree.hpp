// What a URDF says of links and joints, as plain data (http://wiki.ros.org/urdf/XML).
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "cablefit/model/arm/serial_chain.hpp"

namespace cablefit {

enum class UrdfMotion { turns, slides, fixed, other };

struct UrdfJoint {
  std::string name, type;
  std::size_t line = 0;
  UrdfMotion motion = UrdfMotion::fixed;
  std::string mimics;  ///< another joint; empty: none
  std::size_t parent = 0, child = 0;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero(), rpy = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< unit
};

struct UrdfLink {
  std::string name;
  LinkInertia inertia = LinkInertia::Zero();  ///< about the link's frame
  std::ptrdiff_t joint = -1;                  ///< that it hangs on; -1: the root
  std::vector<std::size_t> children;          ///< joints
};

/// A tree: every link but the root hangs on one joint.
struct UrdfTree {
  std::string path;
  std::vector<UrdfLink> links;
  std::vector<UrdfJoint> joints;
  std::size_t root = 0;
};

/// The same body seen from a frame in which its own stands at `origin`, turned by `rotation`.
LinkInertia moved(const LinkInertia& inertia, const Eigen::Matrix3d& rotation,
                  const Eigen::Vector3d& origin);

}  // namespace cablefit
