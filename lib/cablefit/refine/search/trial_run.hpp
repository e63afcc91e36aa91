// Possible next runs: references within the limits of the logs, simulated with the fitted model.
// Internal to refine/.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cablefit/base/axes.hpp"
#include "cablefit/refine/rows/design.hpp"

namespace cablefit {

struct TrialRun {
  double load = 0;        ///< N m, constant
  double speed = 0;       ///< rad/s, the largest of the reference
  bool dithered = false;  ///< with a small dither from 7 to 23 Hz
  bool blocked = false;   ///< the link is blocked: a slow ramp to both sides
  double period = 0;      ///< s
  Eigen::ArrayXd theta_ref;
};

/// "at a load of +30 N m, slow (up to 0.05 rad/s)".
std::string text_of(const TrialRun& run, Axes axes);

/// The cheapest first: the present load, slow and fast, then other loads, then a blocked link (for
/// models with cables). Empty for logs of blocked links alone.
std::vector<TrialRun> trial_runs(const Design& design);

/// The measured signals of a run, without noise; nothing where the simulation diverges. In closed
/// loop with the rig's controller, else with a controller as stiff as the motor's inertia allows.
std::optional<Stretch> simulated(const TrialRun& run, const Model& model);

}  // namespace cablefit
