// A controller for a twin: the rig's, or one that follows what was measured. Internal to prove/.
#pragma once

#include <string>

#include "cablefit/prove/twin.hpp"

namespace cablefit {

/// Fills reference and controller of a stretch whose `measured`, period and log are known. Returns
/// which it is, in words.
std::string choose_controller(const Model& model, const LogSurvey& log, const TwinDrive& drive,
                              TwinStretch& stretch);

}  // namespace cablefit
