// Rigs of several joints whose preload alone is in equilibrium, (8c), for plain_joints.hpp.
#pragma once

#include <complex>

#include "tests/support/plain_rigs.hpp"

namespace cablefit::test {

/// The elongation at which the cable pulls with `force`, by bisection.
inline double elongation_of_force(const PlainCable& cable, double force) {
  double low = 0, high = 1;
  for (int i = 0; i < 200; ++i) {
    const double l = 0.5 * (low + high);
    double f = 0;
    for (std::size_t j = 0; j < cable.k.size(); ++j)
      f += cable.k[j] * std::pow(l, static_cast<double>(j) + 1);
    (f < force ? low : high) = l;
  }
  return low;
}

/// A finger of two joints and four cables, two pairs; the pair of joint 2 passes the link of joint
/// 1 on a pulley of 1 cm. Each pair has its own preload.
inline PlainRig four_cable_finger(double force_1 = 280, double force_2 = 350) {
  PlainRig rig;
  rig.joints = {PlainJoint{}, PlainJoint{}};
  rig.joints[1] = {0.02, 0.004, 0.03, 0.06, 0.01, 0.03, -0.02, 0.25, 0.037, 0.35, 40, 0.4, 1};
  rig.cables = {
      {"flexor", {round_map(0.03), round_map(0)}, {round_map(0.03), round_map(0)}, {3e5, 1e7}},
      {"extensor",
       {round_map(-0.03), round_map(0)},
       {round_map(-0.03), round_map(0)},
       {2.5e5, 2e7}},
      {"pip", {round_map(0), round_map(0.02)}, {round_map(0.01), round_map(0.02)}, {4e5, 1e7}},
      {"dip", {round_map(0), round_map(-0.02)}, {round_map(-0.01), round_map(-0.02)}, {5e5, 2e7}}};
  for (std::size_t c = 0; c < 4; ++c)
    rig.cables[c].l_o = elongation_of_force(rig.cables[c], c < 2 ? force_1 : force_2);
  return rig;
}

/// A straight tendon from a guide (from_x, y) on the base to one at (to_x, y) of link 2, whose axis
/// is `length` from axis 1; its derivatives by complex steps (Squire & Trapp 1998).
inline PlainPath guided(double from_x, double from_y, double to_x, double to_y, double length) {
  using C = std::complex<double>;
  const auto span = [=](C x1, C x2) {
    const C x = length * std::cos(x1) + to_x * std::cos(x1 + x2) - to_y * std::sin(x1 + x2);
    const C y = length * std::sin(x1) + to_x * std::sin(x1 + x2) + to_y * std::cos(x1 + x2);
    return std::sqrt((x - from_x) * (x - from_x) + (y - from_y) * (y - from_y));
  };
  PlainPath path;
  path.way = [span](double x1, double x2) -> std::array<double, 3> {
    constexpr double kStep = 1e-30;
    return {span(x1, x2).real() - span(0, 0).real(), span(C(x1, kStep), x2).imag() / kStep,
            span(x1, C(x2, kStep)).imag() / kStep};
  };
  path.map = fmt::format(
      R"({{"type": "guides", "joints": ["1", "2"], "from": [{}, {}], "to": [{}, {}], "length": {}}})",
      from_x, from_y, to_x, to_y, length);
  return path;
}

/// As four_cable_finger(), but the pair of joint 2 runs straight from guides on the base to guides
/// on link 2, past both joints: its levers on each depend on both angles.
inline PlainRig guided_finger() {
  PlainRig rig = four_cable_finger();
  for (std::size_t c : {2, 3}) {
    const double side = c == 2 ? 1 : -1;
    rig.cables[c].link = {round_map(0), round_map(0)};
    rig.cables[c].paths = {guided(-0.04, 0.014 * side, 0.03, 0.018 * side, 0.05)};
  }
  return rig;
}

/// Two phalanges that move each other, with two pairs of cables; the second passes the first joint.
inline PlainRig four_cable_phalanges() {
  PlainRig rig = phalanges_rig();
  const PlainMap none = round_map(0);
  rig.cables = {
      {"flexor", {round_map(0.01), none}, {round_map(0.01), none}, {1e5, 1.5e7}},
      {"extensor", {round_map(-0.01), none}, {round_map(-0.01), none}, {7e4, 1.5e7}},
      {"pip", {none, round_map(0.006)}, {round_map(0.005), round_map(0.006)}, {5e4, 1e7}},
      {"dip", {none, round_map(-0.006)}, {round_map(-0.005), round_map(-0.006)}, {6e4, 1e7}}};
  for (std::size_t c = 0; c < 4; ++c)
    rig.cables[c].l_o = elongation_of_force(rig.cables[c], c < 2 ? 200 : 90);
  return rig;
}

/// A finger of three joints and four tendons (n + 1): all pull with one force at rest.
inline PlainRig three_joint_finger(double force = 300) {
  PlainRig rig;
  rig.joints.assign(3, PlainJoint{});
  rig.joints[1] = {0.03, 0.004, 0.04, 0.08, 0.015, 0.04, -0.02, 0.22, 0.041, 0.25, 50, 0.5, 1.5};
  rig.joints[2] = {0.015, 0.003, 0.03, 0.06, 0.01, 0.03, 0.01, 0.25, 0.033, 0.3, 40, 0.4, 1};
  // In units of each joint's radius the columns add up to 0.
  const double way[4][3] = {{1, 1, 1}, {-1, 1, 1}, {0, -2, 1}, {0, 0, -3}};
  const double radius[3] = {0.03, 0.02, 0.015};
  const std::vector<double> k[4] = {{2e5, 1e7}, {2.4e5, 0.8e7}, {1.8e5, 1.5e7}, {3e5, 1e7}};
  for (std::size_t c = 0; c < 4; ++c) {
    PlainCable cable;
    cable.name = fmt::format("t{}", c + 1);
    for (std::size_t j = 0; j < 3; ++j) cable.motor.push_back(round_map(way[c][j] * radius[j]));
    cable.link = cable.motor;
    cable.k = k[c];
    cable.l_o = elongation_of_force(cable, force);
    rig.cables.push_back(cable);
  }
  return rig;
}

}  // namespace cablefit::test
