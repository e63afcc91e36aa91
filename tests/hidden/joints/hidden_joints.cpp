// Logs of a finger with an effect hidden on one of its joints. RIG: finger, whose links turn
// inertias of their own, arm, whose links move each other, thumb, an arm that moves in space,
// seven, an arm of seven joints, or hand, two fingers of three joints.
//
//   hidden_joints --list
//   hidden_joints RIG FOLDER NAME SIDE JOINT SIZE SEED     (NAME none: nothing is hidden)
// Exit code 3: the rig has no place for the effect.
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <fstream>
#include <span>

#include "joint_effects.hpp"

namespace cablefit::test {
namespace {

constexpr double kBlocked = 60, kMoving = 24;  // s

void write(const std::string& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  if (!file.flush()) throw std::runtime_error("cannot write " + path);
}

PlainRig rig_of(const std::string& kind) {
  if (kind == "arm") return phalanges_rig();
  if (kind == "thumb") return thumb_rig();
  if (kind == "hand") return two_finger_hand();
  if (kind == "seven") return seven_joint_rig();
  return tendon_finger();
}

void write_case(std::span<char*> args) {
  const std::string folder = args[1], name = args[2], side = args[3];
  const auto seed = static_cast<unsigned>(std::stoul(args[6]));
  const std::string kind = args[0];
  PlainRig rig = rig_of(kind);
  const PlainArm* arm = rig.link_dynamics.target<PlainArm>();
  const std::vector<double> held(rig.n(), 0.1);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> other(0.7, 1.4);
  for (PlainJoint& joint : rig.joints)  // another finger each time
    for (double PlainJoint::*value : {&PlainJoint::J_link, &PlainJoint::f_v, &PlainJoint::f_s,
                                      &PlainJoint::f_vm, &PlainJoint::f_sm, &PlainJoint::swing})
      joint.*value *= other(random);
  if (arm != nullptr) write(folder + "/finger.urdf", urdf_text(*arm, "finger"));
  write(folder + "/rig.json",
        rig_text(rig, arm ? R"( "arm": {"type": "urdf", "file": "finger.urdf"},)" : ""));
  if (name != "none")
    find_joint_effect(name, side).hide(rig, std::stoul(args[4]) - 1, std::stod(args[5]));
  write(folder + "/blocked.csv", blocked_log(rig, held, kBlocked, 10 * seed + 1, 200, 0, 0.005));
  write(folder + "/moving.csv", moving_log(rig, kMoving, 10 * seed + 2));
  rig.joints[0].swing *= 0.8;
  rig.joints[1].swing *= 1.2;
  write(folder + "/test.csv", moving_log(rig, kMoving / 2, 10 * seed + 3));
}

}  // namespace
}  // namespace cablefit::test

int main(int argc, char** argv) {
  try {
    const std::span<char*> args(argv + 1, static_cast<std::size_t>(argc - 1));
    if (args.size() == 1 && std::string(args[0]) == "--list") {
      for (const auto& effect : cablefit::test::joint_effects())
        std::printf("%s %s\n", effect.name.c_str(), effect.side.c_str());
      return 0;
    }
    if (args.size() != 7) throw std::invalid_argument("see the head of hidden_joints.cpp");
    cablefit::test::write_case(args);
  } catch (const cablefit::test::NotPossible& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  return 0;
}
