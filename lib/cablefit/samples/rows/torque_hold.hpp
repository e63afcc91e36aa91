// How long a drive holds its torque, by when the torque acts. Internal.
#pragma once

#include <optional>
#include <string>

#include "cablefit/model/rig.hpp"

namespace cablefit {

/// s after the time stamp of the logged torque, with its sd.
struct TorqueLateness {
  double seconds = 0, sd = 0;
};

/// Periods of the drive in a row of the log: a torque that is held acts half a period late. 0: the
/// torque is not held (a mean, centred); 1: over the row; 2, 4: the log keeps every second or
/// fourth command. `row`: s. Nothing where none of them explains the time, or where it is not
/// known well enough.
std::optional<int> drive_periods(const TorqueLateness& late, double row);

/// Whether a log with a longer sample period (`row`, s) keeps every n-th torque of a drive that
/// holds each for `period` (s), and not those of a drive that holds each for `row`. `later`: how
/// much later the torque acts than in a log of that `period`. Nothing where its sd is too large.
std::optional<bool> is_same_drive(const TorqueLateness& later, double row, double period);

/// s, of a torque that is held over this share of a row; 0: it is not held.
double lateness_of(int periods, double row);

/// A hold that was found. `period`: s, where it is shorter than a row of the log; else 0.
struct FoundHold {
  bool held = false;
  double period = 0;
};
FoundHold hold_of(int periods, double row);
/// "none", "zoh", "zoh, 1 ms".
std::string name_of(const FoundHold& hold);
/// In place of what the rig has.
void set_torque_hold(const FoundHold& hold, Rig& rig);

}  // namespace cablefit
