// A controller for a twin: the rig's, or one that follows what was measured.
#pragma once

#include <string>

#include "cablefit/copies/twin.hpp"

namespace cablefit {

/// Whether a controller of the rig moves every joint of this log; else a twin can only follow what
/// was measured.
bool has_reference(const LogPlan& plan);

/// Fills reference, load and controller of a stretch whose `measured`, period, start and log are
/// known. Returns which it is, in words.
std::string choose_controller(const Model& model, const LogSurvey& log, const TwinDrive& drive,
                              TwinStretch& stretch);

}  // namespace cablefit
