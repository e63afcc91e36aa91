// Stiffness of a transmission at a pose: the slopes of tau_elas_l = P f and tau_elas_m = S f
// (Fichera & Grossard 2017, (8)), with l = g - h + l_o, dl/dq = -P^T, dl/dtheta = S^T. Joint level:
// N m/rad (N/m on a linear axis). Cable level: df/dl, N/m (joint space N m/rad).
#pragma once

#include <Eigen/Core>

#include "cablefit/model/cables.hpp"

namespace cablefit {

/// n_joints x n_joints each; row: torque of that joint, column: position of that joint. `k` is the
/// diagonal matrix of df/dl, g'' and h'' are the second derivatives by the positions: diagonal
/// where no map is one of two joints.
struct StiffnessMatrices {
  Eigen::MatrixXd link_q;       ///< d tau_l/dq = -P k P^T + sum_i f_i h_i''
  Eigen::MatrixXd link_theta;   ///< d tau_l/dtheta = P k S^T
  Eigen::MatrixXd motor_q;      ///< d tau_m/dq = -S k P^T
  Eigen::MatrixXd motor_theta;  ///< d tau_m/dtheta = S k S^T + sum_i f_i g_i''

  /// Second derivatives of the elastic energy (9) by (q, theta), 2n x 2n, symmetric.
  Eigen::MatrixXd energy_hessian() const;
};

/// What is read off the matrices; eigenvalues ascending.
struct StiffnessModes {
  Eigen::VectorXd motors_free;  ///< of d tau_m/dtheta: the links are blocked
  Eigen::VectorXd links_free;   ///< of -d tau_l/dq: the motors are blocked
  /// No eigenvalue of the Hessian of the energy is below 0 (up to rounding): the pose is one of
  /// least energy for its cables.
  bool passive = true;
};

/// theta as logged. A cable at exactly l = 0 counts as slack.
StiffnessMatrices stiffness_matrices(const Transmission& transmission, const Eigen::VectorXd& q,
                                     const Eigen::VectorXd& theta);
StiffnessModes stiffness_modes(const StiffnessMatrices& matrices);

/// df/dl of every cable there; none of the linear model.
Eigen::VectorXd cable_stiffnesses(const Transmission& transmission, const Eigen::VectorXd& q,
                                  const Eigen::VectorXd& theta);

/// Free resonance, Hz, of a motor and a link (kg m^2) joined by a spring (N m/rad):
/// sqrt(K (1/J_m + 1/J_l))/(2 pi).
double free_resonance(double stiffness, double j_motor, double j_link);

/// d tau_m/dtheta of one joint (from 0) turned by phi from the reference pose, the others in it.
double motor_stiffness(const Transmission& transmission, int joint, double phi);

}  // namespace cablefit
