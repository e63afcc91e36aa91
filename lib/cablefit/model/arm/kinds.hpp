// The rows of the table of arms, one per file. Internal to arm.cpp; everybody else goes through
// arm_kinds().
#pragma once

#include "cablefit/base/json_document.hpp"
#include "cablefit/model/arm.hpp"

namespace cablefit::arms {

/// Every joint turns its own inertia.
ArmKind independent();
/// Two links with parallel axes.
ArmKind planar_two_joint();

}  // namespace cablefit::arms
