// A controller for a copy: the rig's, or one that follows what was measured.
#pragma once

#include <string>

#include "cablefit/copies/simulated_copy.hpp"

namespace cablefit {

/// Whether a controller of the rig moves every joint of this log; else a copy can only follow what
/// was measured.
bool has_reference(const LogPlan& plan);

/// Fills reference, load and controller of a stretch whose `measured`, period, start and log are
/// known. Returns which it is, in words.
std::string choose_controller(const Model& model, const LogSurvey& log, const CopyDrive& drive,
                              CopyStretch& stretch);

}  // namespace cablefit
