// Refining stage 1 alone: blocked logs have no link equation, hardly a speed, and show only what
// cables and the motor's dry friction do. Internal to refine/.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "cablefit/refine/refine_options.hpp"
#include "cablefit/refine/rows/design.hpp"

namespace cablefit {

/// What a refinement looks at.
struct RefineStage {
  bool elastic_only = false;
  std::vector<Model> models;
  PartFilter wanted;  ///< parts of the logs
  std::vector<std::string> warnings;
};

/// The elastic stage alone when the models know nothing of the link (stage 1's) or no log moves;
/// the models then have the motor's effects that blocked logs may show, and no link. Throws
/// Error(input) when stage 1's models meet no blocked part or have an effect that none shows, and
/// for a log of another preload than that of a single model.
RefineStage stage_of(std::span<const Model> models, const RefineLogs& logs);

/// Widths of the kernels that suit the slow motion of blocked logs: as wide as it takes for the
/// motion to stand out of the encoder's noise.
Smoothing blocked_smoothing(std::span<const Model> models, const std::vector<Stretch>& stretches);

/// The models without the motor's effects that these logs do not show: columns that cannot be
/// separated from the others, and inertias and frictions that are negative or lost in their sd.
std::vector<Model> with_visible_effects(std::vector<Model> models,
                                        const std::vector<Stretch>& stretches,
                                        const Smoothing& smoothing, double block_seconds);

}  // namespace cablefit
