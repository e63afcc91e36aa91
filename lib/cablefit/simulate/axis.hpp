// One axis of the plant: what moves there, and the friction on it. Internal to the simulator.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "cablefit/model/model.hpp"

namespace cablefit {

class Axis {
 public:
  explicit Axis(const std::vector<EffectInstance>& effects);

  double inertia() const { return inertia_; }

  /// Velocity after the time h under a constant `torque` (N m, all but friction), friction being
  /// that of `position`. Exactly 0 when dry friction can hold the torque.
  double advance(double position, double velocity, double torque, double h) const;

  /// What refinements add to an axis.
  struct Extra {
    double up = 0, down = 0;  ///< N m, dry friction of motion forwards and backwards
    double inertia = 0;       ///< kg m^2
  };
  /// The same with more (or less) dry friction, which stays >= 0 in sum, and inertia.
  double advance(double position, double velocity, double torque, double h,
                 const Extra& extra) const;

 private:
  using TorqueFunction = double (*)(double position, double velocity, const double* parameters);
  struct Term {
    TorqueFunction torque;
    std::size_t first_parameter;
  };
  /// Friction about the present velocity v0: smooth(v) = constant + damping v, dry level of a body
  /// that moves the same way, |v| from rest: level + level_slope |v|.
  struct Friction {
    double constant = 0, damping = 0, level = 0, level_slope = 0;
  };

  void add(const EffectInstance& instance);
  void fold(const Effect& effect, const double* parameters);
  double sum(const std::vector<Term>& terms, double position, double velocity) const;
  Friction friction(double position, double velocity) const;
  static Friction with(const Friction& friction, double more, double velocity);
  double move(const Friction& up, const Friction& down, double inertia, double velocity,
              double push, double h) const;

  std::vector<double> parameters_;
  std::vector<Term> smooth_, dry_;  ///< of the rows that are not affine
  Friction affine_;                 ///< all the others together
  double inertia_ = 0;
};

inline double Axis::sum(const std::vector<Term>& terms, double position, double velocity) const {
  double total = 0;
  for (const Term& term : terms) {
    total += term.torque(position, velocity, parameters_.data() + term.first_parameter);
  }
  return total;
}

inline Axis::Friction Axis::friction(double position, double velocity) const {
  if (smooth_.empty() && dry_.empty()) return affine_;
  // Far below any speed on which friction changes, far above rounding (1e-16 / 1e-6 of a slope).
  const double probe = std::copysign(1e-6 * std::max(1.0, std::abs(velocity)), velocity);
  const double smooth = sum(smooth_, position, velocity);
  const double damping = (sum(smooth_, position, velocity + probe) - smooth) / probe;
  const double level = sum(dry_, position, velocity);
  const double slope = (sum(dry_, position, velocity + probe) - level) / std::abs(probe);
  return {affine_.constant + smooth - damping * velocity, affine_.damping + damping,
          affine_.level + level - slope * std::abs(velocity), slope};
}

/// Trapezoidal rule for J v' = push - damping v.
inline double slid_velocity(double inertia, double velocity, double push, double damping,
                            double h) {
  const double half = 0.5 * h * damping;
  return ((inertia - half) * velocity + h * push) / (inertia + half);
}

/// `push`: all but friction; `up` and `down`: the friction of either direction.
inline double Axis::move(const Friction& up, const Friction& down, double inertia, double velocity,
                         double push, double h) const {
  const auto leave_rest = [&](double time) {
    const Friction& f = push > 0 ? up : down;
    const double excess = std::abs(push) - f.level;
    if (excess <= 0) return 0.0;
    return std::copysign(slid_velocity(inertia, 0.0, excess, f.damping + f.level_slope, time),
                         push);
  };
  if (velocity == 0) return leave_rest(h);
  const Friction& f = velocity > 0 ? up : down;
  const double sliding_push = push - std::copysign(f.level, velocity);
  const double damping = f.damping + f.level_slope;
  const double next = slid_velocity(inertia, velocity, sliding_push, damping, h);
  if (next * velocity > 0) return next;
  // It comes to rest on the way; the same rule solved for the time at which v' = 0.
  const double until_rest = inertia * velocity / (0.5 * damping * velocity - sliding_push);
  return leave_rest(h - std::clamp(until_rest, 0.0, h));
}

inline double Axis::advance(double position, double velocity, double torque, double h) const {
  const Friction f = friction(position, velocity);
  return move(f, f, inertia_, velocity, torque - f.constant, h);
}

inline Axis::Friction Axis::with(const Friction& friction, double more, double velocity) {
  Friction sum = friction;
  sum.level = std::max(friction.level + more, -friction.level_slope * std::abs(velocity));
  return sum;
}

inline double Axis::advance(double position, double velocity, double torque, double h,
                            const Extra& extra) const {
  const Friction f = friction(position, velocity);
  return move(with(f, extra.up, velocity), with(f, extra.down, velocity), inertia_ + extra.inertia,
              velocity, torque - f.constant, h);
}

}  // namespace cablefit
