#include "cablefit/model/catalogue/rows.hpp"

// The paper's model: inertia and friction of each axis.
namespace cablefit::rows {
namespace {

constexpr ParameterInfo kLinkInertia[] = {
    {"J_link", "J_M", "kg m^2", "inertia of the link, with the mass that hangs on it", 0}};
constexpr ParameterInfo kMotorInertia[] = {
    {"J_motor", "J_m", "kg m^2", "inertia of the motor and its reduction, after the reduction", 0}};
constexpr ParameterInfo kRigidInertia[] = {{"J", "J", "kg m^2", "inertia of the whole drive", 0}};

constexpr ParameterInfo kLinkViscous[] = {
    {"f_v", "f_v", "N m s/rad", "viscous friction on the link side", 0}};
constexpr ParameterInfo kMotorViscous[] = {
    {"f_vm", "f_vm", "N m s/rad", "viscous friction on the motor side", 0}};
constexpr ParameterInfo kRigidViscous[] = {
    {"f_v", "f_v", "N m s/rad", "viscous friction of the whole drive", 0}};

constexpr ParameterInfo kLinkDry[] = {{"f_s", "f_s", "N m", "dry friction on the link side", 0}};
constexpr ParameterInfo kMotorDry[] = {
    {"f_sm", "f_sm", "N m", "dry friction on the motor side", 0}};
constexpr ParameterInfo kRigidDry[] = {{"f_s", "f_s", "N m", "dry friction of the whole drive", 0}};

constexpr ParameterInfo kOffset[] = {
    {"offset", "offset", "N m",
     "constant torque of the drive: amplifier offset, gravity of the nut"}};

constexpr std::string_view kFriction = "Fichera & Grossard 2017, (31)";

Effect row(std::string_view name, Site site, std::string_view equation, std::string_view source,
           std::span<const ParameterInfo> parameters, MotionPart follows) {
  Effect effect{.name = name, .site = site};
  effect.equation = equation;
  effect.source = source;
  effect.parameters = parameters;
  effect.follows = follows;
  return effect;
}

}  // namespace

std::vector<Effect> base() {
  using enum Site;
  using enum MotionPart;
  return {
      row("inertia", link, "J_link qdd", "Fichera & Grossard 2017, (14a)", kLinkInertia,
          acceleration),
      row("viscous", link, "f_v qd", kFriction, kLinkViscous, velocity),
      row("coulomb", link, "f_s sgn(qd)", kFriction, kLinkDry, direction),
      row("inertia", motor, "J_motor thetadd", "Fichera & Grossard 2017, (14b)", kMotorInertia,
          acceleration),
      row("viscous", motor, "f_vm thetad", kFriction, kMotorViscous, velocity),
      row("coulomb", motor, "f_sm sgn(thetad)", kFriction, kMotorDry, direction),
      row("offset", motor, "offset", "Fichera & Grossard 2017, Table 2", kOffset, constant),
      row("inertia", rigid, "J qdd", "Fichera & Grossard 2017, (14) with rigid cables",
          kRigidInertia, acceleration),
      row("viscous", rigid, "f_v qd", kFriction, kRigidViscous, velocity),
      row("coulomb", rigid, "f_s sgn(qd)", kFriction, kRigidDry, direction),
      row("offset", rigid, "offset", "Fichera & Grossard 2017, Table 2", kOffset, constant),
  };
}

}  // namespace cablefit::rows
