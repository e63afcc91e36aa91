// Whether the torques of several joints agree. A cable that passes two joints, and the masses of
// links that move each other, are measured by each of these joints: where all that two joints
// measure differs by one factor, the torque of one is off by it (a wrong torque constant; Gautier &
// Briot 2014). No single joint shows that without a load. Internal to refine/.
#pragma once

#include <vector>

#include "cablefit/model/model.hpp"

namespace cablefit {

/// Of one joint.
struct JointScale {
  double scale = 1;  ///< its logged torque over the one that the other joints call for
  double sd = 0;
  bool compared = false;    ///< with another joint
  int n = 0;                ///< quantities that were compared
  double explained = 0;     ///< share of their weighted squared disagreement
  double chance = 1;        ///< probability of such a factor where the torques agree
  std::vector<int> rivals;  ///< joints (from 0) of which one may be wrong instead

  bool is_off() const { return scale != 1; }
};

/// What a joint's own logs say of its torque.
enum class TorqueTrust { off, unknown, weighed };

/// Per joint. `fits`: of each joint its model with the values and sd of a fit; nullptr: there is
/// none. `trust`: of each joint; one that a known load has weighed is right, the others are off.
/// `significance`: the largest chance of a factor that counts.
std::vector<JointScale> joint_scales(const std::vector<const Model*>& fits,
                                     const std::vector<TorqueTrust>& trust, double significance);

}  // namespace cablefit
