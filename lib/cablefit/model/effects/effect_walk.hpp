// One effect of the catalogue along a motion: torque per unit of its linear parameters. What the
// rows of refine and of stage 2 are made of.
#pragma once

#include <vector>

#include "cablefit/model/effects.hpp"

namespace cablefit {

/// Has torques or a level of dry friction; others are in the cables or concern the log.
bool acts_as_torque(const Effect& row);

/// On the only axis of a rigid drive what acts on the link counts too, unless the catalogue has the
/// same law for the motor.
bool counts_on_rigid(const Effect& row);

/// Whether a shape is a number on a continuous range: whole ones (orders, harmonics) are not.
bool is_continuous(const Effect& row, std::size_t shape);

class EffectWalk {
 public:
  /// Of a row that acts_as_torque(), with its nonlinear parameters. Inner states begin at 0.
  EffectWalk(const Effect& row, std::vector<double> shape);

  /// Adds the torques in this state to `link` and `motor` (N m per unit, n_linear() each), and goes
  /// h (s) on. `direction`: sgn of the speed of the row's own axis, or what a filter made of it.
  void step(const JointState& state, double direction, double h, double* link, double* motor);

 private:
  const Effect& row_;
  std::vector<double> shape_, z_, level_;
};

}  // namespace cablefit
