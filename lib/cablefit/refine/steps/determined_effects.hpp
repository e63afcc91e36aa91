// Effects that the base may have. A log that moves in one direction only does not separate dry
// friction from an offset, but can still show a missing effect. Internal to refine/.
#pragma once

#include "cablefit/refine/rows/evidence.hpp"

namespace cablefit {

/// The models without those frictions and offsets of the base that the rows do not separate from
/// the effects before them (inertia, viscous and dry friction, offset, in this order). `warnings`
/// lists each. The models are unchanged where all effects are determined, or where removing them
/// does not help.
std::vector<Model> with_determined_effects(std::vector<Model> models,
                                           const std::vector<Stretch>& stretches,
                                           const Smoothing& smoothing, double block_seconds,
                                           std::vector<std::string>& warnings);

/// Removes a base effect of the link or the motor from the models' joint.
void remove_effect(const Effect& effect, bool on_link, std::vector<Model>& models);

}  // namespace cablefit
