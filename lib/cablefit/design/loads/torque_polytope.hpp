// Torques that cables can make at a pose: tensions only pull, tau_l = P f with
// f >= 0, so they fill a cone (force closure when it is all of space; Murray,
// Li & Sastry 1994, section 5.2), and with 0 <= f <= f_max a zonotope
// (Bosscher, Riechel & Ebert-Uphoff 2006). N m (N on a linear axis).
#pragma once

#include <string>
#include <vector>

#include "cablefit/model/cables.hpp"

namespace cablefit {

/// All of 0 <= f <= f_max through the columns of P (n_joints x n_cables); exact
/// for a few joints.
struct TorquePolytope {
  std::string where;         ///< "at rest", "at the pose"
  Eigen::VectorXd q;         ///< per joint
  Eigen::MatrixXd columns;   ///< P times f_max, n_joints x n_cables
  Eigen::MatrixXd vertices;  ///< n_joints x vertices; of two joints in order around it
  /// Outward normals of its facets, unit length, n_joints x facets; none when
  /// it is flat.
  Eigen::MatrixXd normals;
  bool closure = false;  ///< some tensions > 0 make any torque: 0 lies inside
  /// Without closure: outward normals of the cone of torques that f >= 0 can
  /// make at all.
  Eigen::MatrixXd cone;

  /// Largest d^T tau: sum of max(0, d^T column).
  double support(const Eigen::VectorXd& d) const;
  /// Largest torque of joint j (from 0) in this direction (+1, -1): the others
  /// as they come, and the others 0 (NaN: not without them).
  double largest(int joint, int direction) const;
  double largest_alone(int joint, int direction) const;
};

/// `largest_tension`: of every cable, N (joint space: N m).
TorquePolytope torque_polytope(const Transmission& transmission, std::string where,
                               const Eigen::VectorXd& q, double largest_tension);

/// Load along a direction at which a cable goes slack, motors held.
struct SlackLoad {
  std::string cable;
  double load = 0;
};
/// Under a load on one joint.
struct SlackOrder {
  Eigen::VectorXd direction;  ///< N m per joint, of length 1
  std::vector<SlackLoad> cables;
};
/// In the order in which cables that are taut without load go slack under load
/// * direction, up to `most` N m; cables that stay taut, or a load that the
/// cables do not hold, are left out.
std::vector<SlackLoad> slack_order(const Transmission& transmission,
                                   const Eigen::VectorXd& direction, double most);
/// Both directions of each joint, up to the largest torques of the polytope.
std::vector<SlackOrder> slack_orders(const Transmission& transmission,
                                     const TorquePolytope& polytope);

}  // namespace cablefit
