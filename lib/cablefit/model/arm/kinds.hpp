// The rows of the table of arms, one per file. Internal to arm.cpp; everybody else goes through
// arm_kinds().
#pragma once

#include "cablefit/base/json/json_document.hpp"
#include "cablefit/model/arm.hpp"
#include "cablefit/model/arm/serial_chain.hpp"

namespace cablefit::arms {

/// Every joint turns its own inertia.
ArmKind independent();
/// Two links with parallel axes.
ArmKind planar_two_joint();
/// A chain of joints.
ArmKind serial();
/// The same from a file.
ArmKind urdf();

/// "gravity" of an arm: three numbers, m/s^2, in the frame of its base; standard gravity down z
/// when left out.
Eigen::Vector3d gravity_at(const JsonNode& node);

}  // namespace cablefit::arms
