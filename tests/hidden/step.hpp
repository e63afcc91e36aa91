// One step of one side under a constant torque and Coulomb friction.
#pragma once

namespace hidden {

/// Speed after the step (rad/s; exactly 0 where it sticks) and the way made (rad).
struct Slide {
  double v = 0, dx = 0;
};

/// J dv/dt + f v + lambda = torque over h, lambda in [-down, up] (set-valued, up and down >= 0).
/// While it slides: trapezoidal rule in f v, exact otherwise. A step in which the speed would
/// change its sign is cut where it reaches zero, and goes on from rest: there the side stays unless
/// the torque leaves [-down, up]. After Moreau 1988 (implicit treatment of the set-valued law) with
/// the reversal located instead of smeared over the step.
Slide slide(double v, double J, double f, double torque, double down, double up, double h);

}  // namespace hidden
