#include "cablefit/model/catalogue/rows.hpp"

// Scales and offsets of what is measured. As torques of the MODEL: a column of the measured torque
// would fit itself.
namespace cablefit::rows {
namespace {

constexpr ParameterInfo kScale[] = {{"scale", "a", "", "true theta = (1 + a) logged theta"}};
constexpr ParameterInfo kOffset[] = {{"offset", "a", "rad", "true theta - q = logged + a"}};
constexpr ParameterInfo kGain[] = {{"gain", "a", "", "logged tau = (1 - a) true tau"}};
constexpr ParameterInfo kLoad[] = {{"scale", "a", "", "logged tau_load = (1 - a) true tau_load"}};

void scaled(const JointState& state, const double* /*shape*/, const double* /*z*/, double* link,
            double* motor) {
  pull(state.stiffness * state.theta, 0, link, motor);
}

void shifted(const JointState& state, const double* /*shape*/, const double* /*z*/, double* link,
             double* motor) {
  pull(state.stiffness, 0, link, motor);
}

// J thetadd + ... + tau_elas = tau / (1 - a): times 1 - a, all but tau_elas is in the other
// parameters, and tau_elas falls by a.
void motor_share(const JointState& state, const double* /*shape*/, const double* /*z*/,
                 double* /*link*/, double* motor) {
  motor[0] = -state.tau_elas;
}

// The same on the link: J qdd + ... - tau_elas = tau_load / (1 - a).
void link_share(const JointState& state, const double* /*shape*/, const double* /*z*/, double* link,
                double* /*motor*/) {
  link[0] = state.tau_elas;
}

}  // namespace

Effect encoder_scale() {
  return {.name = "encoder_scale",
          .site = Site::sensor,
          .equation =
              "tau_elas(phi + a theta) - tau_elas(phi) = k a theta, true theta = (1 + a) "
              "logged",
          .signature =
              "opposite on the two sides, proportional to position; over a short range "
              "similar to pulley eccentricity, in the link equation alone similar to gravity",
          .experiment = "one sweep over the whole range of q",
          .source = "a wrong resolution or reduction ratio",
          .parameters = kScale,
          .torque = scaled};
}

Effect encoder_offset() {
  return {.name = "encoder_offset",
          .site = Site::sensor,
          .equation = "tau_elas(phi + a) - tau_elas(phi) = k a, true theta - q = logged + a",
          .signature =
              "opposite on the two sides, proportional to the stiffness; slip starts at a "
              "time, creep follows the load",
          .experiment = "both cables loaded in turn",
          .source = "a reference run that ended elsewhere",
          .parameters = kOffset,
          .is_static = true,
          .torque = shifted};
}

Effect torque_gain() {
  return {.name = "torque_gain",
          .site = Site::drive,
          .alias_class = "scale",
          .equation = "-a tau_elas on the motor, logged tau = (1 - a) true tau",
          .signature =
              "tau_elas of the motor equation and of the link equation differ by a factor; "
              "similar to a wrong load",
          .experiment = "a second load that is known, or the inertia from CAD",
          .source = "a wrong torque constant: Gautier & Briot 2014",
          .parameters = kGain,
          .yardstick = Yardstick::load_or_inertia,
          .torque = motor_share};
}

Effect load_scale() {
  return {.name = "load_scale",
          .site = Site::link,
          .alias_class = "scale",
          .equation = "a tau_elas on the link, logged tau_load = (1 - a) true tau_load",
          .signature =
              "tau_elas of the link equation and of the motor equation differ by a factor; "
              "similar to a wrong torque constant",
          .experiment = "a second load that is known, or the inertia from CAD",
          .source = "a wrong load mass or radius: Gautier & Briot 2014",
          .parameters = kLoad,
          .yardstick = Yardstick::load,
          .torque = link_share};
}

}  // namespace cablefit::rows
