// A controller for a twin: the rig's, or one that follows what was measured. Internal to prove/.
#pragma once

#include <string>

#include "cablefit/prove/twin.hpp"

namespace cablefit {

/// Whether a controller of the rig moves every joint of this log; else a twin can only follow what
/// was measured.
bool has_reference(const LogPlan& plan);

/// Fills reference and controller of a stretch whose `measured`, period and log are known. Returns
/// which it is, in words.
std::string choose_controller(const Model& model, const LogSurvey& log, const TwinDrive& drive,
                              TwinStretch& stretch);

}  // namespace cablefit
