// A serial arm as plain numbers: where each joint's axis is, and what torque each link's standard
// inertial parameters ask of a joint. Those torques are linear in the parameters, so the columns of
// the regressor need no masses; and they come from the kinematics alone, by virtual work, which is
// why no dynamics library is asked (tests compare with KDL's).
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "cablefit/model/effects.hpp"

namespace cablefit {

/// Of one link, in the frame of its joint, about that frame's origin: mass M (kg), first moments
/// MX = M x, ... (kg m), and the inertia tensor [XX XY XZ; XY YY YZ; XZ YZ ZZ] (kg m^2), so that XY
/// is minus the integral of x y (Khalil & Dombre 2004, ch. 9; URDF's ixy).
enum class LinkParameter { M, MX, MY, MZ, XX, XY, XZ, YY, YZ, ZZ };
inline constexpr Eigen::Index kLinkParameters = 10;
std::string_view name_of(LinkParameter parameter);
std::string_view unit_of(LinkParameter parameter);

using LinkInertia = Eigen::Matrix<double, kLinkParameters, 1>;

/// A joint and the link that it moves, as in a URDF: with the joint at 0 the link's frame stands at
/// `origin` (m), turned by `rpy` (rad; about the fixed axes x, y, z), in the frame of the link
/// before. `axis` (unit) is the same in both.
struct ChainJoint {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d rpy = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  bool slides = false;                        ///< along the axis (m, N) instead of turning about it
  LinkInertia inertia = LinkInertia::Zero();  ///< what the description says; 0: unknown
};

struct SerialChain {
  std::vector<ChainJoint> joints;  ///< from the base to the tip
  std::vector<int> rig_joint;      ///< of each: its place (from 0) among the rig's joints
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< m/s^2, in the frame of the base

  Eigen::Index n_joints() const { return static_cast<Eigen::Index>(joints.size()); }
  /// Every link has a mass.
  bool is_described() const;
  /// No joint turns.
  bool only_slides() const;
  Eigen::Index n_parameters() const { return kLinkParameters * n_joints(); }
};

/// R = Rz(yaw) Ry(pitch) Rx(roll). What is within 1e-5 of a right angle is one: files write 1.5708,
/// and the 4e-6 left would part axes that are parallel.
Eigen::Matrix3d rotation_of(const Eigen::Vector3d& rpy);
/// The other way round, roll 0 where only yaw - roll counts.
Eigen::Vector3d rpy_of(const Eigen::Matrix3d& rotation);
/// The unit vector along `axis`, components within 1e-5 of 0 put there.
Eigen::Vector3d unit_axis(const Eigen::Vector3d& axis);

/// Torque (sliding: force) of the rig's joint `joint` per unit of each of the parameters
/// `wanted` (10 i + LinkParameter for the i-th joint of the chain, ascending), a column each:
/// M(q) qdd + C(q, qd) + g(q). `links`: motion of the rig's joints, n rows each. From the
/// velocity w, acceleration wd and the origin's acceleration vd of every link's frame (vd -
/// gravity, Luh, Walker & Paul 1980) and its motion per unit of the joint's speed (Kane & Levinson
/// 1985).
void serial_regressor(const SerialChain& chain, std::span<const Motion> links, int joint,
                      std::span<const Eigen::Index> wanted, Eigen::Ref<Eigen::MatrixXd> columns);

}  // namespace cablefit
