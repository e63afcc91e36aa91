// Stiffness of a transmission at rest, at a pose and along a log, and the nearest preload in
// equilibrium: what `cablefit design` says of cables without a sweep. SI; on a linear axis read N
// for N m and m for rad.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "cablefit/model/stiffness.hpp"
#include "cablefit/samples/survey/survey.hpp"

namespace cablefit {

/// Theta as logged.
struct PoseStiffness {
  std::string where;  ///< "at rest", "at the pose"
  Eigen::VectorXd q, theta;
  Eigen::VectorXd elongation, tension, stiffness;  ///< per cable: l, f, df/dl
  StiffnessMatrices joints;
  StiffnessModes modes;
};
PoseStiffness stiffness_at_pose(const Transmission& transmission, std::string where,
                                const Eigen::VectorXd& q, const Eigen::VectorXd& theta);
/// In the reference pose.
PoseStiffness stiffness_at_rest(const Transmission& transmission);

/// Of every joint over the samples of a log: d tau_m,j / d theta_j, and of all of them the least
/// eigenvalue of d tau_m/dtheta.
struct StiffnessAlong {
  std::string log;
  std::size_t n_samples = 0, n_closure = 0, n_passive = 0;
  Eigen::VectorXd least, largest;  ///< per joint
  double least_eigenvalue = 0, largest_eigenvalue = 0;
};
/// Throws Error(input) when the log has other joints than the transmission.
StiffnessAlong stiffness_along(const Transmission& transmission, const LogSurvey& log, int threads);

/// One cable of a preload and of the nearest one in equilibrium, (8c).
struct BalancedCable {
  std::string name;
  double l_o = 0, tension = 0;
  double balanced_l_o = 0, balanced_tension = 0;
};
struct Balance {
  Eigen::VectorXd link, motor;  ///< torques that the preload alone makes, per joint
  std::vector<BalancedCable> cables;
};
Balance nearest_balance(const Transmission& transmission);

}  // namespace cablefit
