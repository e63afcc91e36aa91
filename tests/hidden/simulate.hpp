// Runs the bench with hidden effects and records what a logger would, and what really happened.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hooks.hpp"
#include "reference.hpp"

namespace hidden {

/// One recording to be made.
struct Run {
  std::string name;         ///< file name without .csv
  std::string role;         ///< "train", "test" or "blocked"
  int number = 0;           ///< order in which the runs are made; an event stays in later ones
  double load = 0;          ///< N m, as logged
  bool blocked = false;     ///< link held at q = 0
  Reference reference;      ///< rad, of the motor
  std::uint64_t noise = 0;  ///< seed of the torque noise
  std::string preload;      ///< "" or the name of the preload setting
  double l_o = 0;           ///< rad, of cable 1 at this preload; cable 2 balances it
};

/// One entry per sample at 1 kHz.
struct Signals {
  std::vector<double> q, theta, tau, theta_ref;
  double load = 0;
  bool blocked = false;
  double l_o_1 = 0, l_o_2 = 0;  ///< initial elongations, known; rad
};

struct Recording {
  Signals logged;  ///< encoder counts, torque with noise
  Signals exact;   ///< what the sensors show without counts and noise: the effects of sensors stay
};

/// Rate of the log and of the controller, Hz; steps of the integrator in one sample.
constexpr double kRate = 1000;
constexpr int kSubsteps = 40;

/// Implicit midpoint rule in position and torque (two passes of a fixed-point iteration, whose
/// contraction h^2 k / 4 J is below 1e-4), `slide` for the friction. Starts at rest in the balance
/// of the reference and settles 0.5 s before t = 0. `substeps` is for tests of convergence.
Recording simulate(const Bench& bench, const std::vector<Hooks>& hooks, const Run& run,
                   int substeps = kSubsteps);

}  // namespace hidden
