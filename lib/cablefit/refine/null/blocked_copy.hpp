// Blocked logs without any effect beyond the model: the same motion of the motor, the torque of the
// model, the same rounding and noise. A blocked motor is slow and its inertia often unknown, so the
// measured motion is used and no controller is needed. Internal to refine/.
#pragma once

#include <vector>

#include "cablefit/copies/coloured_noise.hpp"
#include "cablefit/refine/rows/motion.hpp"

namespace cablefit {

struct BlockedCopy {
  std::vector<Stretch> stretches;  ///< with the true theta and tau
  struct Sensors {
    double quantum = 0, noise_theta = 0;  ///< rad
    double noise_tau = 0;                 ///< N m, sd of white noise
  };
  std::vector<Sensors> sensors;  ///< per stretch
};

/// `models`: by Stretch::model. Sensors as in the rig files, else as the recordings show.
BlockedCopy make_blocked_copy(const std::vector<Model>& models, std::vector<Stretch> stretches,
                              const Smoothing& wanted);

/// One recording of the copy. `disturbance`: a torque besides the model's; sd 0: none.
std::vector<Stretch> record(const BlockedCopy& copy, const ArModel& disturbance,
                            std::uint64_t seed);

}  // namespace cablefit
