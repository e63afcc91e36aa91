// What the base may have: a log that moves in one direction only does not separate dry friction
// from an offset, and is no less worth a look at what is missing. Internal to refine/.
#pragma once

#include "cablefit/refine/rows/evidence.hpp"

namespace cablefit {

/// The models without the friction and offset of the base that the rows do not separate from what
/// stands before them (inertia, viscous and dry friction, offset, in this order); `warnings` says
/// each. The models themselves where all is determined, or where that does not help.
std::vector<Model> with_determined_effects(std::vector<Model> models,
                                           const std::vector<Stretch>& stretches,
                                           const Smoothing& smoothing, double block_seconds,
                                           std::vector<std::string>& warnings);

/// Takes a base effect of the link or the motor out of the models' joint.
void remove_effect(const Effect& effect, bool on_link, std::vector<Model>& models);

}  // namespace cablefit
