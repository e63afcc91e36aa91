#include <cmath>

#include "cablefit/model/catalogue/rows.hpp"

// Dry friction that grows with what the drive carries.
namespace cablefit::rows {
namespace {

constexpr ParameterInfo kMu[] = {
    {"mu", "mu", "", "dry friction per cable force at the pulley (N m per N m)", 0}};
constexpr ParameterInfo kPathMu[] = {
    {"mu", "mu", "", "share of its tension that a cable loses at each pulley", 0}};
constexpr ParameterInfo kLoadMu[] = {{"mu", "mu", "", "dry friction per load torque", 0}};
constexpr ParameterInfo kLoss[] = {
    {"loss", "a", "", "share of tau_elas lost while the motor drives", 0}};

void tension_level(const JointState& state, double /*direction*/, const double* /*shape*/,
                   const double* /*z*/, double* level) {
  level[0] = state.tension;
}

void path_loss(const JointState& state, const double* /*shape*/, const double* /*z*/, double* link,
               double* /*motor*/) {
  link[0] = state.path_friction;
}

void load_level(const JointState& state, double /*direction*/, const double* /*shape*/,
                const double* /*z*/, double* level) {
  level[0] = std::abs(state.load);
}

void driving_level(const JointState& state, double direction, const double* /*shape*/,
                   const double* /*z*/, double* level) {
  level[0] = state.tau_elas * direction > 0 ? std::abs(state.tau_elas) : 0;
}

}  // namespace

Effect tension_friction(Site side) {
  constexpr TwoSides<std::string_view> kEquation{"mu (T1 + T2) sgn(qd)",
                                                 "mu (T1 + T2) sgn(thetad)"};
  return {.name = "tension_friction",
          .site = side,
          .equation = kEquation.at(side),
          .signature =
              "dry friction that grows with load and preload; Stribeck friction depends "
              "on speed, a torque gain does not change sign with direction",
          .experiment = "the same motion under two loads or at two preloads",
          .source = "Miyasaka et al. 2015; Kaneko et al. 1991",
          .parameters = kMu,
          .is_static = side == Site::motor,
          .level = tension_level};
}

Effect path_friction() {
  return {.name = "path_friction",
          .site = Site::link,
          .equation =
              "mu r_j sum T_i sgn(v_ik) over cables i and pulleys k <= j, v_ik = sum r_il qd_l "
              "over l >= k",
          .signature =
              "dry friction that changes sign with the motion of other joints; tension friction "
              "follows the joint's own speed",
          .experiment = "move each joint with the others at rest, then all together",
          .source = "Euler 1769 (capstan equation); Kaneko et al. 1991",
          .parameters = kPathMu,
          .yardstick = Yardstick::shared_cable,
          .torque = path_loss};
}

Effect load_friction() {
  return {.name = "load_friction",
          .site = Site::motor,
          .equation = "mu |tau_load| sgn(thetad), on a rigid drive",
          .signature =
              "dry friction that grows with the load; drive efficiency costs only while the "
              "motor drives, and cables carry the load of an elastic drive: tension friction",
          .experiment = "the same motion under two loads",
          .source = "Duclusaud et al. 2025",
          .parameters = kLoadMu,
          .yardstick = Yardstick::load,
          .level = load_level};
}

Effect drive_efficiency() {
  return {.name = "drive_efficiency",
          .site = Site::motor,
          .equation = "a |tau_elas| sgn(thetad) while tau_elas thetad > 0",
          .signature =
              "friction with load while the motor drives, none while the load does; "
              "tension friction is there both ways",
          .experiment = "lift and lower the same load",
          .source = "reductions with unlike efficiency forwards and backwards, ball screws",
          .parameters = kLoss,
          .level = driving_level};
}

}  // namespace cablefit::rows
