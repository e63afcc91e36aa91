// Effects of a model beyond those of (31), as columns of an equation of stage 2. They come from the
// catalogue, as found by `refine`.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cablefit/base/axes.hpp"
#include "cablefit/model/effects.hpp"
#include "cablefit/model/motion_part.hpp"
#include "cablefit/samples/rows/signals.hpp"

namespace cablefit {

/// The parameter of one of the first columns, which is the torque per unit of it.
struct DynamicParameter {
  ParameterInfo info;
  std::string name;             ///< with the joint's index when there are several
  Axes axes = Axes::rotary;     ///< of its joint; an arm's base parameters have their own unit
  bool is_inertia = false;      ///< of one axis
  std::optional<double> given;  ///< by the rig file or a model, so not estimated
  MotionPart follows = MotionPart::several;
  /// With a nonlinear parameter the column's parameter is the distance from `origin`. Then both
  /// ends of its range.
  bool is_nonlinear = false;
  double origin = 0, lowest = -kUnbounded, highest = kUnbounded;

  std::string unit() const { return unit_for(axes, info.unit); }
  /// The value after a step from the origin. A step is at most half of the value, or half of the
  /// range where the range contains 0. The value stays in the range.
  double moved(double step) const;
};

/// An effect in one equation. A linear parameter has a column: torque per unit, N m. The column of
/// a nonlinear one is the derivative of the torque at the value of `instance`. Effects of the
/// transmission and of the sensors act in both equations and keep the values of `instance`.
struct AddedEffect {
  EffectInstance instance;
  Side side = Side::motor;
  int joint = 0;  ///< from 0
  bool is_held = false;
  std::vector<std::size_t> moving_shapes;  ///< those with a column: continuous, and fitted

  Eigen::Index n_columns() const;
};

/// Throws Error(usage) for effects that a fit of rows does not support: given twice, no torque (an
/// error of the drive, other cables), a scale of torques, an event, a memory of time, or not
/// defined on a rigid drive. Also for an effect that would keep its value but has none, and for
/// friction on paths where none of `cables` passes several joints.
void require_fittable(const EffectsPerJoint& effects, bool rigid, std::span<const Cable> cables);

/// Those of the joint's fittable `instances` that act in its equation of this side.
std::vector<AddedEffect> effects_of_side(std::span<const EffectInstance> instances, Side side,
                                         int joint);

/// The parameters of an effect's columns, named as those of one of `n_joints` joints.
std::vector<DynamicParameter> parameters_of(const AddedEffect& effect, int n_joints);

/// What effects of one joint depend on, over the rows of a window.
struct JointMotion {
  std::vector<JointState> states;
  Eigen::ArrayXd q_direction, theta_direction;
  double period = 0;      ///< s
  bool is_rigid = false;  ///< its one axis is the motor
};

/// Of joint `joint`, at place `at` of the signals: its own, or that of a copy of all joints.
/// `cables`: of all joints; nullptr on a rigid drive. `effects`: those that will need it.
JointMotion joint_motion(const Transmission* cables, const Signals& signals, std::size_t at,
                         int joint, std::span<const AddedEffect> effects);

/// The columns of an effect over full-rate rows.
void fill_columns(const AddedEffect& effect, const JointMotion& motion,
                  Eigen::Ref<Eigen::MatrixXd> out);

}  // namespace cablefit
