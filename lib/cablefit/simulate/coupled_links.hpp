// The links of a coupled arm, which advance together. Internal to the simulator.
#pragma once

#include <vector>

#include "cablefit/model/arm/arm_dynamics.hpp"
#include "cablefit/simulate/axis.hpp"
#include "cablefit/simulate/coupled_friction.hpp"

namespace cablefit {

/// Over a step of length h, with what is frozen at its middle,
///
///   (M(q) + I) (v' - v) = h (F - C(q, v_mid) v_mid - g(q) - d (v + v') / 2 - lambda),
///   lambda_k in level_k Sgn(v'_k),
///
/// Moreau's time stepping (1988; Stewart & Trinkle 1996). C takes the velocity extrapolated to the
/// middle from the step before. Within the step velocities go linearly, and where a joint comes to
/// rest the step is cut: the rest of it begins there, with the joint at exactly 0, which then
/// sticks or leaves. So stops and reversals keep the second order, as those of a single Axis. A
/// joint that sticks at the end of a step stands still exactly.
class CoupledLinks {
 public:
  /// `links`: their friction.
  CoupledLinks(const Arm& arm, const std::vector<Estimate>& base, const std::vector<Axis>& links);

  /// What acts on joint `joint` in the coming step but friction and the arm's own torques, N m.
  void push(std::size_t joint, double torque, const Axis::Extra& extra);
  /// Positions of the middle of the step; velocities become those of its end.
  void advance(const double* q, double* qd, double h);

  /// Before the first step, and where it goes on from another state.
  void start(const double* q, const double* qd);
  /// Goes on with the accelerations that `before` ended with.
  void take_history(const CoupledLinks& before) { change_ = before.change_; }
  /// M(q) was positive definite up to now.
  bool is_sane() const { return is_sane_; }
  /// Of one joint, the others held, without extra inertia: kg m^2, in the last step.
  double inertia(std::size_t joint) const { return arm_.mass()[joint * (n_ + 1)]; }

 private:
  /// As far as all joints keep moving as they do, at most `time`: what is left of it.
  double advance_until_stop(double* qd, double time);
  /// All of `time`; what comes to rest in it is at rest at its end.
  void advance_to_end(double* qd, double time);
  void fill_matrix(double time);
  /// N m over the joint's damping at `velocity`; without dry friction.
  double net_torque(std::size_t joint, double velocity) const;
  bool is_dry(std::size_t joint) const { return levels_[joint].up + levels_[joint].down > 0; }
  /// On the way from `qd` by what it is moved.
  bool comes_to_rest(std::size_t joint, const double* qd) const {
    return qd[joint] != 0 && is_dry(joint) && qd[joint] * (qd[joint] + moved_[joint]) <= 0;
  }

  std::size_t n_;
  ArmDynamics arm_;
  CoupledFriction friction_;
  std::vector<Axis::Friction> own_;             ///< per joint
  std::vector<CoupledFriction::Law> levels_;    ///< per joint, N m
  std::vector<CoupledFriction::Law> impulses_;  ///< per joint, N m s
  std::vector<double> torque_, inertia_;        ///< per joint, of the coming step
  std::vector<double> matrix_, right_, moved_;
  std::vector<double> middle_;  ///< velocities, rad/s
  std::vector<double> change_;  ///< of the velocities over the last step, rad/s
  bool is_sane_ = true;
};

}  // namespace cablefit
