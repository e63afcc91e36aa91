// The rows of the catalogue of refinements, by family. Internal to refinements.cpp; everybody else
// goes through refinements().
#pragma once

#include "cablefit/model/refinements.hpp"

namespace cablefit::rows {

// Torques that depend on nothing but the side, or on position.
Refinement constant_torque();
Refinement asymmetric_coulomb(Site side);
Refinement gravity_imbalance();
Refinement cogging();

// Friction. `side`: link or motor.
Refinement asymmetric_viscous(Site side);
Refinement stribeck(Site side);
Refinement quadratic_drag(Site side);
Refinement nonlinear_viscous(Site side);
Refinement position_friction(Site side);
Refinement tension_friction(Site side);
Refinement load_friction();
Refinement drive_efficiency();
Refinement presliding(Site side);
Refinement friction_drift(Site side);

// Between the sides.
Refinement cable_damping();
Refinement cable_hysteresis();
Refinement creep();
Refinement pulley_eccentricity();
Refinement stiffness_order();
Refinement stiffness_asymmetry();
Refinement dead_zone();
Refinement preload();

// What is measured and what is commanded.
Refinement encoder_scale();
Refinement encoder_offset();
Refinement encoder_delay();
Refinement torque_delay();
Refinement offset_drift();
Refinement torque_gain();
Refinement load_scale();
Refinement saturation();
Refinement drive_dead_band();

// Dated.
Refinement slip();
Refinement contact();
Refinement payload_change();

/// What differs between the two sides of one row.
template <typename T>
struct TwoSides {
  T link, motor;

  constexpr const T& at(Site side) const { return side == Site::link ? link : motor; }
};

template <Site kSide>
double position(const JointState& state) {
  return kSide == Site::link ? state.q : state.theta;
}
template <Site kSide>
double speed(const JointState& state) {
  return kSide == Site::link ? state.qd : state.thetad;
}
/// The row's own array of the two that `torque` writes.
template <Site kSide>
double* own(double* link, double* motor) {
  return kSide == Site::link ? link : motor;
}

/// A torque between the sides: it slows the motor and drives the link, as tau_elas does.
inline void pull(double torque, std::size_t i, double* link, double* motor) {
  link[i] = -torque;
  motor[i] = torque;
}

/// State of an elastic slider (Dahl 1968) after the way `way` (rad, signed):
/// dz/dx = (1 - z sgn x') / distance, |z| <= 1, solved exactly.
double slid(double z, double way, double distance);
/// 1 - exp(-t/T) for t > 0, else 0.
double settled(double t, double T);
/// sin x, cos x, sin 2x, cos 2x.
void two_harmonics(double x, double* values);
/// A linear transmission as a pair of linear cables per joint, of the same torque.
Transmission linear_pairs(const Transmission& transmission);

}  // namespace cablefit::rows
