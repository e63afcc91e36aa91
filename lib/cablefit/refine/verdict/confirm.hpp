// Does the refined model simulate the test logs better? A smaller equation error alone may be an
// artefact of filters (Aguirre et al. 2010). Internal to refine/.
#pragma once

#include <span>
#include <string>

#include "cablefit/model/model.hpp"
#include "cablefit/samples/survey/survey.hpp"

namespace cablefit {

/// rms of simulated minus measured over all moving parts.
struct SimulatedGap {
  double deflection = 0;  ///< rad; of theta on a rigid drive
  double tau = 0;         ///< N m, in closed loop only
  std::string failure;    ///< why there is no value: a simulation diverged; empty: there is one
  bool known() const { return failure.empty(); }
};

/// Simulates the moving parts of the logs, each with the model of its preload (a single model: all
/// parts). `compared`: see ReplayOptions.
SimulatedGap simulated_gap(std::span<const Model> models, std::span<const LogSurvey> logs,
                           int threads, double compared = 1);

/// Both gaps in units of their floor, squared and summed.
double in_floors(const SimulatedGap& gap, const SimulatedGap& floor);

}  // namespace cablefit
