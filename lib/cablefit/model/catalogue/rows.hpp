// The rows of the catalogue of effects, by family. Internal to effects.cpp; everybody else goes
// through effects().
#pragma once

#include "cablefit/model/effects.hpp"

namespace cablefit::rows {

/// The paper's model, side by side.
std::vector<Effect> base();

/// Of the rig file. They have no function.
std::vector<Effect> rig_errors();

// Torques that depend on nothing but the side, or on position.
Effect constant_torque();
Effect asymmetric_coulomb(Site side);
Effect gravity_imbalance();
Effect cogging();

// Friction. `side`: link or motor.
Effect asymmetric_viscous(Site side);
Effect stribeck(Site side);
Effect quadratic_drag(Site side);
Effect nonlinear_viscous(Site side);
Effect position_friction(Site side);
Effect tension_friction(Site side);
Effect path_friction();
Effect load_friction();
Effect drive_efficiency();
Effect presliding(Site side);
Effect friction_drift(Site side);

// Between the sides.
Effect cable_damping();
Effect cable_hysteresis();
Effect creep();
Effect pulley_eccentricity();
Effect stiffness_order();
Effect stiffness_asymmetry();
Effect dead_zone();
Effect preload();

// What is measured and what is commanded.
Effect encoder_scale();
Effect encoder_offset();
Effect encoder_delay();
Effect torque_delay();
Effect offset_drift();
Effect torque_gain();
Effect load_scale();
Effect saturation();
Effect drive_dead_band();

// Dated.
Effect slip();
Effect contact();
Effect payload_change();

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
