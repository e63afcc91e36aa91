#include "cablefit/dynamic/rows/delay_hold.hpp"

namespace cablefit {

FoundHold hold_of(const TorqueDelay& found) { return {found.held, found.period}; }

void set_torque_hold(const TorqueDelay& found, Rig& rig) {
  FoundHold hold = hold_of(found);
  if (!(hold.period > 0)) hold.period = rig.torque_period;
  set_torque_hold(hold, rig);
}

}  // namespace cablefit
