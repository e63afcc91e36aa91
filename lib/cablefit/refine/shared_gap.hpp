// The gap of one of several joints whose torque is off by a factor. Its own values absorb the
// factor; those that other joints measure as well do not. Internal to refine/.
#pragma once

#include <span>
#include <vector>

#include "cablefit/model/model.hpp"
#include "cablefit/refine/refine_options.hpp"

namespace cablefit {

/// Squared residual of the joint's equations with the others' values of what they share, over that
/// with its own.
struct SharedGap {
  double train = 1, test = 1;
  double elastic_torque = 0;  ///< N m rms in the motor's equation
};

/// `own`: models of the joint, one per preload. `agreed`: of the same joint, with the values of the
/// others. Everything that is not shared is fitted again. Without test logs the last third of the
/// moving ones is held out. No gap where the joint has no base fit.
SharedGap shared_gap(const std::vector<Model>& own, const Model& agreed, const RefineLogs& logs);

}  // namespace cablefit
