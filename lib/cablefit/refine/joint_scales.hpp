// Whether the torques of several joints agree. Each of the joints that a cable passes measures its
// coefficients; each of several coupled links measures their masses. Where all these values of a
// joint differ from those of the others by one factor, its torque is off by this factor (a wrong
// torque constant; Gautier & Briot 2014). No single joint shows that without a load. Internal to
// refine/.
#pragma once

#include <vector>

#include "cablefit/model/model.hpp"

namespace cablefit {

/// Whether a joint's own load confirms its torque: the two contradict each other, there is no
/// load, or they agree.
enum class TorqueTrust { contradicted, unknown, confirmed };

/// Of one joint.
struct JointScale {
  double scale = 1;  ///< its logged torque over that of the reference joints
  double sd = 0;
  bool comparable = false;  ///< no load contradicts the torque of the reference joints
  int n = 0;                ///< values that it shares with other joints
  double explained = 0;     ///< share of the joints' weighted squared disagreement
  double chance = 1;        ///< probability of such a factor where the torques agree
  double dof = 1;           ///< of the t distribution of the factor
  std::vector<int> rivals;  ///< joints (from 0) that may be the wrong ones instead

  bool is_off() const { return scale != 1; }
};

/// Per joint. `fits`: of each joint its model with the values and sd of a fit; nullptr: there is
/// none. `trust`: of each joint. `significance`: the largest chance of a factor that counts.
std::vector<JointScale> joint_scales(const std::vector<const Model*>& fits,
                                     const std::vector<TorqueTrust>& trust, double significance);

}  // namespace cablefit
