// References of the motor at 1 kHz: random-phase multisines that start and stay at rest for 0.1 s.
#pragma once

#include <cstdint>
#include <vector>

#include "plant.hpp"

namespace hidden {

using Reference = std::vector<double>;  ///< rad, one entry per ms

/// The reference of a moving run.
struct Multisine {
  double seconds = 20;
  double lowest = 0.05, highest = 0.5;  ///< Hz
  double fall = 1;                      ///< amplitudes fall as f^-fall
  double peak = 0.5;                    ///< rad
  double dither = 0;                    ///< N m rms of 5-45 Hz; asked of the motor through the PD
  std::uint64_t seed = 1;
};

/// The dither is a torque: its lines in the reference are divided by what the PD makes of them, so
/// that a tool that knows the controller can simulate the run from theta_ref alone.
Reference multisine(const Multisine& spec, const Bench& bench);

/// Slow sweeps of +-`range` (rad) of deflection at a blocked link, with smaller loops in between.
Reference sweep(double seconds, double range, const Bench& bench);

}  // namespace hidden
