// Refines stage 1 alone. Blocked logs have no link equation and hardly a speed, so they show only
// effects of the cables and of the motor's dry friction. Internal to refine/.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "cablefit/refine/refine_options.hpp"
#include "cablefit/refine/rows/design.hpp"

namespace cablefit {

/// Models and parts of the logs for a refinement.
struct RefineStage {
  bool elastic_only = false;
  std::vector<Model> models;
  PartFilter wanted;  ///< parts of the logs
  std::vector<std::string> warnings;
};

/// The elastic stage alone when the models have no link (stage 1's) or no log moves. The models
/// then have the motor's effects that blocked logs may show, and no link. Throws Error(input) when
/// stage 1's models have no blocked part or an effect that none shows, and for a log of another
/// preload than that of a single model.
RefineStage stage_of(std::span<const Model> models, const RefineLogs& logs);

/// Widths of the kernels for the slow motion of blocked logs: as wide as is necessary for the
/// motion to exceed the encoder's noise.
Smoothing blocked_smoothing(std::span<const Model> models, const std::vector<Stretch>& stretches);

/// The models without the motor's effects that these logs do not show: columns that are not
/// separable from the others, and inertias and frictions that are negative or smaller than their
/// sd.
std::vector<Model> with_visible_effects(std::vector<Model> models,
                                        const std::vector<Stretch>& stretches,
                                        const Smoothing& smoothing, double block_seconds);

}  // namespace cablefit
