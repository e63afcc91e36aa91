// The hold that the delay of a log's torque tells, in the rig. Internal.
#pragma once

#include "cablefit/dynamic/dynamic_result.hpp"
#include "cablefit/samples/rows/torque_hold.hpp"

namespace cablefit {

FoundHold hold_of(const TorqueDelay& found);
/// Of a rig whose file leaves the hold open. A period that it gives stays.
void set_torque_hold(const TorqueDelay& found, Rig& rig);

}  // namespace cablefit
