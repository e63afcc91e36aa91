// Links that hang on their cables: the equilibrium under a constant load torque with the motors
// held, slack cables included. rad and N m (m and N on a linear axis).
#pragma once

#include <string>
#include <vector>

#include "cablefit/model/cables.hpp"

namespace cablefit {

/// The stationary point of U(q, theta) - tau_load^T q over q, where tau_elas_l + tau_load = 0
/// (Fichera & Grossard 2017, (9), (14a) at rest, without friction).
struct HeldLoad {
  double l_o = 0;                           ///< of the first cable
  std::vector<double> initial_elongations;  ///< per cable
  bool is_own = false;                      ///< the preload that the model has
  Eigen::VectorXd load;                     ///< tau_load per joint
  Eigen::VectorXd q;                        ///< of the links
  Eigen::VectorXd deflection;               ///< theta - theta_0 - N q, from that without load
  /// The same if a cable kept its stiffness at l = 0 when it is slack, and could push.
  Eigen::VectorXd without_slack;
  Eigen::VectorXd elongation, tension;  ///< per cable

  /// Share of |deflection| that there is because cables go slack, 0..1.
  double slack_share() const;
};

/// The motors are at theta_o. `load`: n_joints. Newton steps on the energy, with the eigenvalues of
/// slack directions raised, halved until it falls; to 1e-10 of the load. Throws Error(input) when
/// the cables do not hold the load.
HeldLoad hold_load(const Transmission& transmission, const Eigen::VectorXd& load);

}  // namespace cablefit
