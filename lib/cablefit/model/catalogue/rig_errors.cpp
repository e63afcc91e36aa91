#include "cablefit/model/catalogue/rows.hpp"

// What several joints together show of the rig file.
namespace cablefit::rows {
namespace {

constexpr ParameterInfo kRadius[] = {
    {"radius", "r", "m", "of the pulley, with the sign of the rig file"}};

Effect cable_radius(Site side) {
  constexpr TwoSides<std::string_view> kEquation{
      "l = ... - r q, r not the link_radius of the rig file",
      "l = ... + r theta, r not the motor_radius of the rig file"};
  return {.name = "cable_radius",
          .site = side,
          .equation = kEquation.at(side),
          .signature =
              "an elongation of one cable proportional to the motion of one joint, in the "
              "equations of every joint that the cable passes",
          .experiment = "move this joint with the others at rest",
          .source = "Fichera & Grossard 2017, (3)-(4)",
          .parameters = kRadius};
}

constexpr ParameterInfo kGravity[] = {{"g_x", "g_x", "m/s^2", "in the frame of the arm's base"},
                                      {"g_y", "g_y", "m/s^2", "in the frame of the arm's base"},
                                      {"g_z", "g_z", "m/s^2", "in the frame of the arm's base"}};

Effect gravity_direction() {
  return {.name = "gravity_direction",
          .site = Site::link,
          .equation = "g(q) of the arm, not along the \"gravity\" of the rig file",
          .signature =
              "torques of the links' weights, which depend on the poses of all joints; gravity "
              "imbalance depends on one joint alone",
          .experiment = "move all joints slowly, so that each link points in many directions",
          .source = "Khalil & Dombre 2004, ch. 9",
          .parameters = kGravity};
}

}  // namespace

std::vector<Effect> rig_errors() {
  return {cable_radius(Site::link), cable_radius(Site::motor), gravity_direction()};
}

}  // namespace cablefit::rows
