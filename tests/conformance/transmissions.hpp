// Transmissions of every routing that the conformance tests go through.
#pragma once

#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "cablefit/base/json/json_document.hpp"
#include "cablefit/model/rig.hpp"

namespace cablefit::test {

struct Routing {
  std::string name, rig;
};

/// Rig files without laws.
inline const std::vector<Routing>& routings() {
  static const std::vector<Routing> kRoutings{
      {"one joint, two cables, r1 != r2", R"({
        "cables": [{"name": "1", "motor_radius": 0.03, "link_radius": 0.05},
                   {"name": "2", "motor_radius": -0.03, "link_radius": -0.05}]})"},
      {"two joints, four cables", R"({"joints": [{"name": "1"}, {"name": "2"}],
        "cables": [{"name": "1", "motor_radius": [0.03, 0], "link_radius": [0.03, 0]},
                   {"name": "2", "motor_radius": [-0.03, 0], "link_radius": [-0.03, 0]},
                   {"name": "3", "motor_radius": [0, 0.02], "link_radius": [0.01, 0.02]},
                   {"name": "4", "motor_radius": [0, -0.02], "link_radius": [-0.01, -0.02]}]})"},
      {"two joints, three coupled cables", R"({"joints": [{"name": "1"}, {"name": "2"}],
        "cables": [{"name": "1", "motor_radius": [0.03, 0.02], "link_radius": [0.03, 0.02]},
                   {"name": "2", "motor_radius": [-0.03, 0.02], "link_radius": [-0.03, 0.02]},
                   {"name": "3", "motor_radius": [0, -0.04], "link_radius": [0, -0.04]}]})"},
      {"pulleys that are not round", R"({
        "cables": [{"name": "1", "motor_radius": 0.03,
                    "link_radius": {"type": "polynomial", "coefficients": [0.03, 0.01, -0.006]}},
                   {"name": "2", "motor_radius": {"type": "polynomial", "coefficients": [-0.03, 0.004]},
                    "link_radius": {"type": "table", "angle": [-0.8, -0.2, 0.3, 0.6, 0.9],
                                    "displacement": [0.025, 0.006, -0.008, -0.02, -0.028]}}],
        "reference_pose": {"q": 0.1, "theta": 0.05}})"},
      {"tendon finger, a tendon over both joints", R"({"joints": [{"name": "mcp"}, {"name": "pip"}],
        "cables": [{"name": "flexor", "motor_radius": [0.01, 0], "link_radius": [0.01, 0.007]},
                   {"name": "extensor", "motor_radius": [-0.01, 0], "link_radius": [-0.008, -0.005]},
                   {"name": "pip", "motor_radius": [0, 0.006],
                    "link_radius": [0, {"type": "polynomial", "coefficients": [0.006, 0.001]}]}]})"},
      {"maps of two joints", R"({"joints": [{"name": "mcp"}, {"name": "pip"}],
        "cables": [{"name": "flexor", "motor_radius": [0.03, 0],
                    "link_map": {"type": "guides", "joints": ["mcp", "pip"],
                                 "from": [-0.05, 0.03], "to": [0.04, 0.02], "length": 0.05}},
                   {"name": "extensor", "motor_radius": [-0.03, 0], "link_radius": [-0.02, 0],
                    "link_map": [{"type": "polynomial", "joints": ["pip", "mcp"],
                                  "coefficients": [[0.003, -0.005, 0.002], [-0.01, 0.03, 0.01]]}]},
                   {"name": "pip", "link_radius": [0, 0.02],
                    "motor_map": {"type": "grid", "joints": ["mcp", "pip"],
                                  "angle_1": [-0.4, -0.1, 0.25], "angle_2": [-0.3, 0, 0.1, 0.5],
                                  "displacement": [[-0.007, -0.001, 0.002, 0.011],
                                                   [-0.006, 0, 0.0025, 0.012],
                                                   [-0.003, 0.004, 0.006, 0.016]]}}],
        "reference_pose": {"q": [0.05, 0.1], "theta": [0.02, 0.08]}})"}};
  return kRoutings;
}

/// The routing with this law, its orders different from cable to cable, and preload.
inline Transmission transmission_of(const Routing& routing, const CableLaw& law) {
  Transmission transmission = parse_rig(parse_json(routing.rig, "rig.json")).transmission;
  int number = 0;
  for (Cable& cable : transmission.cables) {
    cable.law = &law;
    cable.order = 1 + number++ % law.max_order;
    cable.toe = law.has_toe ? 0.004 : 0;
    cable.initial_elongation = 0.001;
    cable.coefficients.clear();
    for (int j = 0; j < cable.n_coefficients(); ++j) {
      // Of the size 1e5 N/m at a few millimetres, whatever the power.
      cable.coefficients.push_back((1e5 + 2e4 * number) * std::pow(200.0, law.length_power(j) - 1));
    }
  }
  return transmission;
}

/// Runs `check(transmission)` for every law with every routing.
template <typename Check>
void for_every_transmission(Check check) {
  for (const CableLaw& law : cable_laws()) {
    for (const Routing& routing : routings()) {
      INFO(law.name << " cables: " << routing.name);
      check(transmission_of(routing, law));
    }
  }
}

}  // namespace cablefit::test
