// Whether the torques of several joints agree. A cable that passes two joints, and the masses of
// links that move each other, are measured by each of these joints: where all that a joint measures
// differs from the others by one factor, its torque is off by it (a wrong torque constant; Gautier
// & Briot 2014). No single joint shows that without a load. Internal to refine/.
#pragma once

#include <vector>

#include "cablefit/model/model.hpp"

namespace cablefit {

/// What a joint's own logs say of its torque: against its load it is off, or nothing, or right.
enum class TorqueTrust { off, unknown, weighed };

/// Of one joint.
struct JointScale {
  double scale = 1;  ///< its logged torque over the one that the other joints call for
  double sd = 0;
  bool settled = false;     ///< compared with a joint whose torque its own load does not contradict
  int n = 0;                ///< values that were compared
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
