// One axis of the plant over a step, with the derivatives of what it does. Internal to simulate/.
#pragma once

#include <vector>

#include "cablefit/simulate/axis.hpp"

namespace cablefit {

class SensitiveAxis {
 public:
  /// Of base effects, which have one parameter each.
  explicit SensitiveAxis(const std::vector<EffectInstance>& effects);

  /// v' = velocity after a step as a function of velocity and force (N m, all but friction): its
  /// value and partial derivatives there.
  struct Step {
    double velocity = 0;
    double by_velocity = 0, by_force = 0;
  };

  /// As Axis::advance. While the axis is held by dry friction all derivatives are 0. Those by
  /// parameters are left in by_parameter().
  Step advance(double velocity, double force, double h);

  double inertia() const { return axis_.inertia(); }
  /// Level of dry friction, N m; 0 without.
  double dry_level() const { return axis_.friction().level; }
  std::size_t n_parameters() const { return effects_.size(); }
  /// The parameter of the effect of that number; update() is to be called afterwards.
  double& parameter(std::size_t effect) { return effects_[effect].parameters.front().value; }
  void update() { axis_ = Axis(effects_); }
  const std::vector<double>& by_parameter() const { return by_parameter_; }

 private:
  /// A stretch of the step in which the axis moves one way (sigma = +-1; 0: no dry friction).
  struct Slide {
    double end = 0;  ///< velocity, as `mean`
    double mean = 0;
    double push = 0;  ///< mean force less friction, N m
    double sigma = 0;
  };

  Slide slide(double velocity, double force, double sigma, double h) const;
  Step moving(double velocity, double force, double sigma, double h);
  Step stopping(double velocity, double force, double sigma, double h);
  Step leaving(double force, double h);
  /// Adds factor * d(push)/d(parameter) of a slide.
  void add_by_parameter(double factor, const Slide& slide);

  std::vector<EffectInstance> effects_;
  Axis axis_;
  std::vector<double> by_parameter_;
  bool has_dry_ = false;
};

}  // namespace cablefit
