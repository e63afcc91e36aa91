// The torques of a moving log fitted to the positions of all motors and links.
#pragma once

#include <Eigen/Core>

#include "cablefit/samples/weigh/coarse_rows.hpp"

namespace cablefit::weighing {

/// Slopes of the torque of every motor (rows) over all theta and all q, beside accelerations and
/// friction. Cables make them K and -K S, S as in stiff_motors.hpp, with a positive diagonal of K,
/// as (6) is convex. A row of 0: not known.
struct TorqueSlopes {
  Eigen::MatrixXd theta, q;
  Eigen::VectorX<bool> is_clear;  ///< the diagonal of theta
  Eigen::MatrixXd clear_q;        ///< q where it is clear, else 0
};

/// Every joint has q, theta and tau.
TorqueSlopes fit_torques(const CoarsePart& part);

}  // namespace cablefit::weighing
