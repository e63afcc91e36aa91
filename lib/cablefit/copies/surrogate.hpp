// A controller for a copy: the rig's, or a surrogate that follows the measured motion.
#pragma once

#include <string>

#include "cablefit/copies/simulated_copy.hpp"

namespace cablefit {

/// Whether a controller of the rig moves every joint of this log. Otherwise a copy can only follow
/// the measured motion.
bool has_reference(const LogPlan& plan);

/// Fills reference, load and controller of a stretch. Its `measured`, period, start and log must be
/// set. Returns the choice in words.
std::string choose_controller(const Model& model, const LogSurvey& log, const CopyDrive& drive,
                              CopyStretch& stretch);

}  // namespace cablefit
