// What the refinements of one joint do during a step. Internal to the simulator.
#pragma once

#include <utility>
#include <vector>

#include "cablefit/model/model.hpp"
#include "cablefit/simulate/axis.hpp"

namespace cablefit {

/// Torques on the left side, N m: they oppose.
struct RefinedStep {
  double link_torque = 0, motor_torque = 0;
  Axis::Extra link, motor;
};

class RefinedJoint {
 public:
  /// `log_number`: of the log that is simulated, see SimulationInput.
  RefinedJoint(const std::vector<EffectInstance>& refinements, std::size_t log_number);

  /// Over a step of length h. `state`: of its middle, but with the velocities of its beginning,
  /// which are extrapolated to the middle, and without accelerations.
  RefinedStep step(JointState state, double h);
  /// The next step begins with other velocities than the last one ended with, and goes on with its
  /// accelerations.
  void jump() { has_jumped_ = true; }
  /// Inner states and last accelerations as `before` has them, of the same refinements.
  void take_history(const RefinedJoint& before);

 private:
  struct Term {
    const Effect* row;
    std::vector<double> linear, shape, z;
    double event_time;  ///< s since this log began; +-infinity in a log before or after it
    bool is_directed;   ///< its level differs between directions
    bool carries;       ///< its torque grows with an acceleration: an inertia
    std::vector<double> link, motor;  ///< per unit, room to write
  };

  static Term make_term(const EffectInstance& instance, std::size_t log_number);
  static std::pair<double, double> torques(Term& term, const JointState& state);
  static double level(Term& term, const JointState& state, double direction);
  static void act(Term& term, const JointState& state, double h, RefinedStep& sum);
  static void add_inertia(Term& term, JointState state, double link, double motor,
                          RefinedStep& sum);

  std::vector<Term> terms_;
  double qd_before_ = 0, thetad_before_ = 0;  ///< at the beginning of the last step
  double qd_change_ = 0, thetad_change_ = 0;  ///< up to then, over the step before it
  bool has_begun_ = false, has_jumped_ = false;
};

/// No refinement that acts on the plant, as most models have it.
bool is_plain(const Model& model);

}  // namespace cablefit
