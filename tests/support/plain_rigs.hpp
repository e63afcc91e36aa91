// Rigs for plain_joints.hpp, and how a rig file says them.
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "tests/support/plain_arm.hpp"
#include "tests/support/plain_joints.hpp"

namespace cablefit::test {

/// The rig file; `more`: further keys, each with a comma behind it. `search`: it does not know l_o.
inline std::string rig_text(const PlainRig& rig, const std::string& more, bool search = false) {
  const auto numbers = [](const std::vector<PlainMap>& maps) {
    std::string list;
    for (const PlainMap& map : maps) {
      std::string one = fmt::format("{}", map.radius.front());
      if (map.radius.size() > 1)
        one = fmt::format(R"({{"type": "polynomial", "coefficients": [{}]}})",
                          fmt::join(map.radius, ", "));
      list += (list.empty() ? "" : ", ") + one;
    }
    return list;
  };
  std::string joints, cables;
  for (std::size_t j = 0; j < rig.n(); ++j)
    joints += fmt::format(R"({}{{"name": "{}"}})", j > 0 ? ", " : "", j + 1);
  const auto paths = [](const PlainCable& cable) {
    std::string list;
    for (const PlainPath& path : cable.paths) list += (list.empty() ? "" : ", ") + path.map;
    return list.empty() ? "" : fmt::format(R"("link_map": [{}], )", list);
  };
  for (const PlainCable& cable : rig.cables)
    cables += fmt::format(
        R"({}{{"name": "{}", "motor_radius": [{}], "link_radius": [{}], {}"order": {}, "initial_elongation": {}}})",
        cables.empty() ? "" : ",\n  ", cable.name, numbers(cable.motor), numbers(cable.link),
        paths(cable), cable.k.size(), search ? R"("search")" : fmt::format("{}", cable.l_o));
  return fmt::format(R"({{"schema": "cablefit/rig/1", "joints": [{}],{} "cables": [{}]}})", joints,
                     more, cables);
}

inline PlainMap round_map(double radius) { return {{radius}}; }

/// n + 1 cables: two joints that share all of their three cables.
inline PlainRig three_coupled_cables() {
  PlainRig rig;
  rig.joints = {PlainJoint{}, PlainJoint{}};
  rig.joints[1] = {0.03, 0.004, 0.03, 0.06, 0.01, 0.03, -0.02, 0.25, 0.037, 0.25, 50, 0.5, 1};
  const auto pulleys = [](double first, double second) {
    return std::vector<PlainMap>{round_map(first), round_map(second)};
  };
  rig.cables = {{"1", pulleys(0.03, 0.02), pulleys(0.03, 0.02), {2e5, 1e7}, 2e-3},
                {"2", pulleys(-0.03, 0.02), pulleys(-0.03, 0.02), {2e5, 1e7}, 2e-3},
                {"3", pulleys(0, -0.04), pulleys(0, -0.04), {2.4e5, 0.8e7}, 2e-3}};
  return rig;
}

/// A finger of two joints and three tendons, preloaded so that all are taut at rest.
inline PlainRig tendon_finger() {
  PlainRig rig;
  rig.joints = {PlainJoint{}, PlainJoint{}};
  rig.joints[0] = {4e-3, 8e-4, 4e-3, 6e-3, 2e-3, 5e-3, 4e-3, 0.6, 0.05, 0.5, 6, 0.06, 0.1};
  rig.joints[1] = {1.5e-3, 5e-4, 3e-3, 4e-3, 1e-3, 4e-3, -3e-3, 0.5, 0.037, 0.5, 4, 0.04, 0.05};
  rig.torque_noise = 4e-3;
  const auto pulleys = [](const PlainMap& first, const PlainMap& second) {
    return std::vector<PlainMap>{first, second};
  };
  const PlainMap none = round_map(0);
  rig.cables = {{"flexor",
                 pulleys(round_map(0.01), none),
                 pulleys(round_map(0.01), round_map(0.007)),
                 {1e5},
                 2e-3},
                {"extensor",
                 pulleys(round_map(-0.01), none),
                 pulleys(round_map(-0.01), round_map(-0.009)),
                 {7e4, 1.5e7},
                 2e-3},
                {"pip",
                 pulleys(none, round_map(0.006)),
                 pulleys(none, {{0.006, 0.001}}),
                 {5e4, 1e7, 1e9},
                 1.5e-3}};
  return rig;
}

/// The same joints with two tendons each, 2n; those of the tip pass the first joint.
inline PlainRig paired_finger() {
  PlainRig rig = tendon_finger();
  const auto pulleys = [](double first, double second) {
    return std::vector<PlainMap>{round_map(first), round_map(second)};
  };
  rig.cables = {{"mcp", pulleys(0.01, 0), pulleys(0.01, 0), {1e5, 1e7}, 2e-3},
                {"back", pulleys(-0.01, 0), pulleys(-0.01, 0), {7e4, 1.5e7}, 2e-3},
                {"pip", pulleys(0, 0.006), pulleys(0.005, 0.006), {5e4}, 1.5e-3},
                {"tip", pulleys(0, -0.006), pulleys(-0.005, -0.007), {6e4, 1e7}, 1.5e-3}};
  return rig;
}

/// Two fingers of three joints and five tendons each: the long ones pass all joints of a finger, so
/// that its links move together.
inline PlainRig two_finger_hand() {
  PlainRig rig;
  rig.torque_noise = 4e-3;
  const std::vector<PlainJoint> finger = {
      {4e-3, 8e-4, 4e-3, 6e-3, 2e-3, 5e-3, 4e-3, 0.5, 0.05, 0.5, 6, 0.06, 0.1},
      {2e-3, 6e-4, 3e-3, 4e-3, 1e-3, 4e-3, -3e-3, 0.5, 0.037, 0.5, 5, 0.05, 0.05},
      {8e-4, 4e-4, 2e-3, 3e-3, 1e-3, 3e-3, 2e-3, 0.4, 0.043, 0.4, 10, 0.04, 0.03}};
  struct Tendon {
    const char* name;
    std::size_t motor;
    double radius;
    std::vector<double> link;
    std::vector<double> k;
    double l_o;
  };
  const std::vector<Tendon> tendons = {
      {"flexor", 0, 0.01, {0.01, 0.007, 0.005}, {1e5}, 2e-3},
      {"extensor", 0, -0.01, {-0.01, -0.007, -0.008}, {7e4, 1.5e7}, 2e-3},
      {"pip", 1, 0.008, {0, 0.007, 0.004}, {5e4}, 2e-3},
      {"back", 1, -0.008, {0, -0.008, -0.004}, {5e4}, 2e-3},
      {"dip", 2, 0.006, {0, 0, 0.006}, {5e4}, 2e-3}};
  for (std::size_t f = 0; f < 2; ++f) {
    rig.joints.insert(rig.joints.end(), finger.begin(), finger.end());
    for (const Tendon& tendon : tendons) {
      std::vector<PlainMap> motor(6, round_map(0)), link(6, round_map(0));
      motor[3 * f + tendon.motor] = round_map(tendon.radius);
      for (std::size_t j = 0; j < 3; ++j) link[3 * f + j] = round_map(tendon.link[j]);
      rig.cables.push_back(
          {fmt::format("{}{}", tendon.name, f + 1), motor, link, tendon.k, tendon.l_o});
    }
  }
  return rig;
}

/// The finger of two joints, its links the phalanges of plain_arm.hpp; no other torque acts on
/// them.
inline PlainRig phalanges_rig() {
  PlainRig rig = tendon_finger();
  rig.link_dynamics = phalanges();
  for (PlainJoint& joint : rig.joints) joint.load = 0;
  return rig;
}

/// One finger of the hand with the links of the thumb; no other torque acts on them.
inline PlainRig thumb_rig() {
  PlainRig rig = two_finger_hand();
  rig.joints.resize(3);
  rig.cables.resize(5);
  for (PlainCable& cable : rig.cables) {
    cable.motor.resize(3);
    cable.link.resize(3);
  }
  rig.link_dynamics = thumb();
  for (PlainJoint& joint : rig.joints) joint.load = 0;
  return rig;
}

/// An arm of seven joints, a pair of cables per joint.
inline PlainRig seven_joint_rig() {
  PlainRig rig;
  rig.link_dynamics = seven_joints();
  const double swings[] = {0.8, 0.7, 0.9, 0.8, 1, 0.9, 1};
  for (int j = 0; j < 7; ++j) {
    PlainJoint joint;
    joint.swing = swings[j];
    joint.load = 0;
    joint.sweep_rate = 0.05 + 0.004 * j;
    joint.kp = j < 4 ? 90 : 40;
    joint.kd = j < 4 ? 1.2 : 0.4;
    joint.J_motor = j < 4 ? 0.01 : 0.004;
    joint.f_s = 0.1 - 0.01 * j;
    rig.joints.push_back(joint);
    for (const double side : {1.0, -1.0}) {
      PlainCable cable;
      cable.name = fmt::format("{}{}", j + 1, side > 0 ? "a" : "b");
      cable.motor.assign(7, round_map(0));
      cable.motor[static_cast<std::size_t>(j)] = round_map(side * 0.03);
      cable.link = cable.motor;
      cable.k = {j < 4 ? 6e5 : 3e5, side > 0 ? 2e7 : 1e7};
      rig.cables.push_back(cable);
    }
  }
  return rig;
}

}  // namespace cablefit::test
