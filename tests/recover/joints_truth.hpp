// What both stages should find of a plain rig, by the names of results.
#pragma once

#include <string>

#include "tests/support/plain_joints.hpp"
#include "tests/support/recover.hpp"

namespace cablefit::test {

/// "J_link[2]" on a rig of two joints.
inline std::string name_of(const PlainRig& rig, const char* name, std::size_t joint) {
  return rig.n() > 1 ? fmt::format("{}[{}]", name, joint + 1) : name;
}

/// What the rig file says of an arm whose links move each other.
inline constexpr const char* kUrdfArm = R"( "arm": {"type": "urdf", "file": "arm.urdf"},)";

/// Base parameters of the rig's URDF.
inline NamedValues arm_truth(const Rig& rig) {
  NamedValues truth;
  const std::vector<double> described = rig.arm.described();
  const auto base = rig.arm.base_parameters();
  REQUIRE(described.size() == base.size());
  for (std::size_t k = 0; k < base.size(); ++k) truth.emplace_back(base[k].name, described[k]);
  return truth;
}

inline NamedValues stage1_truth(const PlainRig& rig) {
  NamedValues values;
  for (const PlainCable& cable : rig.cables)
    for (std::size_t j = 0; j < cable.k.size(); ++j)
      values.emplace_back(fmt::format("k[{}]_{}", cable.name, j), cable.k[j]);
  for (std::size_t j = 0; j < rig.n(); ++j) {
    values.emplace_back(name_of(rig, "offset", j), rig.joints[j].offset);
    values.emplace_back(name_of(rig, "f_sm", j), rig.joints[j].f_sm);
  }
  return values;
}

inline NamedValues stage2_truth(const PlainRig& rig) {
  NamedValues values;
  for (std::size_t j = 0; j < rig.n(); ++j) {
    const PlainJoint& joint = rig.joints[j];
    if (!rig.link_dynamics) values.emplace_back(name_of(rig, "J_link", j), joint.J_link);
    values.emplace_back(name_of(rig, "f_v", j), joint.f_v);
    values.emplace_back(name_of(rig, "f_s", j), joint.f_s);
    values.emplace_back(name_of(rig, "J_motor", j), joint.J_motor);
    values.emplace_back(name_of(rig, "f_vm", j), joint.f_vm);
    values.emplace_back(name_of(rig, "f_sm", j), joint.f_sm);
    values.emplace_back(name_of(rig, "offset", j), joint.offset);
  }
  return values;
}

}  // namespace cablefit::test
