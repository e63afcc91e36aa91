// The part of the motion that a torque follows. A motion separates two torques when the parts that
// they follow differ in it.
#pragma once

#include <string>

#include "cablefit/base/axes.hpp"

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
inline std::string motion_unit(MotionPart part, Axes axes) {
  switch (part) {
    case MotionPart::velocity:
      return unit_for(axes, "rad/s");
    case MotionPart::acceleration:
      return unit_for(axes, "rad/s^2");
    case MotionPart::position:
      return unit_for(axes, "rad");
    case MotionPart::several:
    case MotionPart::constant:
    case MotionPart::direction:
    case MotionPart::joints:
      break;
  }
  return "";
}

}  // namespace cablefit
