// The part of the motion that a torque follows. A motion separates two torques when the parts that
// they follow differ in it.
#pragma once

#include <string_view>

namespace cablefit {

enum class MotionPart {
  several,  ///< more than one part, or a part without a name here
  constant,
  direction,  ///< sgn(velocity)
  velocity,
  acceleration,
  position,
  joints,  ///< accelerations and velocities of several joints at once
};

/// "rad/s"; empty for parts without a unit of their own.
constexpr std::string_view motion_unit(MotionPart part, bool linear_motion) {
  switch (part) {
    case MotionPart::velocity:
      return linear_motion ? "m/s" : "rad/s";
    case MotionPart::acceleration:
      return linear_motion ? "m/s^2" : "rad/s^2";
    case MotionPart::position:
      return linear_motion ? "m" : "rad";
    case MotionPart::several:
    case MotionPart::constant:
    case MotionPart::direction:
    case MotionPart::joints:
      break;
  }
  return "";
}

}  // namespace cablefit
