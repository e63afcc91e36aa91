// One axis of the plant over a step, with the derivatives of what it does. Internal to simulate/.
#pragma once

#include <vector>

#include "cablefit/model/model.hpp"

namespace cablefit {

class SensitiveAxis {
 public:
  explicit SensitiveAxis(const std::vector<EffectInstance>& effects);

  /// v' = velocity after a step as a function of velocity, position (that of friction) and force
  /// (N m, all but friction): its value and partial derivatives there.
  struct Step {
    double velocity = 0;
    double by_velocity = 0, by_position = 0, by_force = 0;
  };

  /// As Axis::advance, with friction of the mean velocity (implicit midpoint rule, solved to
  /// rounding) where that one linearises it: the same for friction that is affine in velocity, and
  /// differentiable with first derivatives of friction alone. While the axis is held by dry
  /// friction all derivatives are 0. Those by parameters are left in by_parameter().
  Step advance(double position, double velocity, double force, double h);

  double inertia() const { return inertia_; }
  /// Level of dry friction, N m; 0 without.
  double dry_level(double position, double velocity) const;
  /// All effects' parameters, one after another.
  std::vector<double>& parameters() { return parameters_; }
  /// Number of the first parameter of the effect of that number.
  std::size_t first_parameter(std::size_t effect) const { return terms_[effect].first; }
  const std::vector<double>& by_parameter() const { return by_parameter_; }
  /// To be called after parameters have changed.
  void update();

 private:
  struct Term {
    const Effect* effect;
    std::size_t first, n;
  };
  /// Friction level sigma included, at one mean velocity.
  struct Friction {
    double torque = 0, by_position = 0, by_velocity = 0;
  };
  /// A stretch of the step in which the axis moves one way (sigma = +-1; 0: no dry friction).
  struct Slide {
    double velocity = 0;  ///< at its end
    double push = 0;      ///< mean force less friction, N m
    Friction friction;
  };

  Friction friction(double position, double velocity, double sigma);
  Slide slide(double position, double velocity, double force, double sigma, double h);
  Step moving(double position, double velocity, double force, double sigma, double h);
  Step stopping(double position, double velocity, double force, double sigma, double h);
  Step leaving(double position, double force, double h);
  /// Adds factor * d(push)/d(parameter) of the friction looked at last.
  void add_by_parameter(double factor, double push);

  std::vector<Term> terms_;
  std::vector<double> parameters_, by_parameter_;
  std::vector<double> slopes_;      ///< of friction by parameter, where it was looked at last
  std::vector<double> inertia_by_;  ///< of the inertia by parameter
  std::vector<double> scratch_;
  double inertia_ = 0;
  bool has_dry_ = false;
};

}  // namespace cablefit
