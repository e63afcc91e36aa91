// One axis of the plant: what moves there, and the friction on it. Internal to the simulator.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "cablefit/model/model.hpp"

namespace cablefit {

/// Trapezoidal rule for J v' = push - damping v.
inline double slid_velocity(double inertia, double velocity, double push, double damping,
                            double h) {
  const double half = 0.5 * h * damping;
  return ((inertia - half) * velocity + h * push) / (inertia + half);
}

class Axis {
 public:
  /// Of base effects.
  explicit Axis(const std::vector<EffectInstance>& effects);

  /// constant + damping v + level sgn(v), N m; at rest any torque up to the level is held.
  struct Friction {
    double constant = 0, damping = 0, level = 0;
  };
  /// What other effects add to an axis.
  struct Extra {
    double up = 0, down = 0;  ///< N m, dry friction of motion forwards and backwards
    double inertia = 0;       ///< kg m^2
  };

  double inertia() const { return inertia_; }
  const Friction& friction() const { return friction_; }

  /// Velocity after the time h under a constant `torque` (N m, all but friction). Exactly 0 when
  /// dry friction, which stays >= 0 in sum, can hold the torque.
  double advance(double velocity, double torque, double h, const Extra& extra) const {
    return move(std::max(friction_.level + extra.up, 0.0),
                std::max(friction_.level + extra.down, 0.0), inertia_ + extra.inertia, velocity,
                torque - friction_.constant, h);
  }
  double advance(double velocity, double torque, double h) const {
    return move(friction_.level, friction_.level, inertia_, velocity, torque - friction_.constant,
                h);
  }

 private:
  double move(double up, double down, double inertia, double velocity, double push, double h) const;

  Friction friction_;
  double inertia_ = 0;
};

/// `push`: all but friction; `up` and `down`: the level of dry friction of either direction.
inline double Axis::move(double up, double down, double inertia, double velocity, double push,
                         double h) const {
  const auto leave_rest = [&](double time) {
    const double excess = std::abs(push) - (push > 0 ? up : down);
    if (excess <= 0) return 0.0;
    return std::copysign(slid_velocity(inertia, 0.0, excess, friction_.damping, time), push);
  };
  if (velocity == 0) return leave_rest(h);
  const double sliding_push = push - std::copysign(velocity > 0 ? up : down, velocity);
  const double next = slid_velocity(inertia, velocity, sliding_push, friction_.damping, h);
  if (next * velocity > 0) return next;
  // It comes to rest on the way; the same rule solved for the time at which v' = 0.
  const double until_rest =
      inertia * velocity / (0.5 * friction_.damping * velocity - sliding_push);
  return leave_rest(h - std::clamp(until_rest, 0.0, h));
}

}  // namespace cablefit
