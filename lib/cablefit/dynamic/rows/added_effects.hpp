// Effects that a model has beyond those of (31), as columns of an equation of stage 2: whatever
// `refine` finds, by its row of the catalogue.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cablefit/model/effects.hpp"
#include "cablefit/model/motion_part.hpp"
#include "cablefit/samples/rows/signals.hpp"

namespace cablefit {

/// What one of the first columns is the torque per unit of.
struct DynamicParameter {
  ParameterInfo info;
  std::string name;             ///< with the joint's index when there are several
  bool is_inertia = false;      ///< of one axis
  std::optional<double> given;  ///< by the rig file or a model, and not estimated
  MotionPart follows = MotionPart::several;
  /// Of a nonlinear parameter the column's is the distance from `origin`; both ends of its range.
  bool is_nonlinear = false;
  double origin = 0, lowest = -kUnbounded, highest = kUnbounded;

  /// The value after a step from the origin. A step is at most half of the value, or half of the
  /// range where the range holds 0. The value stays in the range.
  double moved(double step) const;
};

/// An effect in one equation. A linear parameter has a column: torque per unit, N m. A nonlinear
/// one has the derivative of the torque at the value of `instance`. Effects of the transmission and
/// of the sensors act in both equations; they are held at the values of `instance`.
struct AddedEffect {
  EffectInstance instance;
  Side side = Side::motor;
  bool is_held = false;
  std::vector<std::size_t> moving_shapes;  ///< with a column: continuous, and looked for

  Eigen::Index n_columns() const;
};

/// Throws Error(usage) for effects that a fit of rows cannot have: given twice, no torque (an error
/// of the drive, other cables), a scale of torques, a date, a memory of time, none on a rigid
/// drive; and for one that would be held, but has no value.
void require_fittable(std::span<const EffectInstance> effects, bool rigid);

/// Those of `instances`, which are fittable, that act in an equation of this side.
std::vector<AddedEffect> effects_of_side(std::span<const EffectInstance> instances, Side side);

/// What the columns of an effect are.
std::vector<DynamicParameter> parameters_of(const AddedEffect& effect);

/// Its columns over full-rate rows. `cables`: nullptr on a rigid drive.
void fill_columns(const AddedEffect& effect, const Transmission* cables, const Signals& signals,
                  std::size_t joint, Eigen::Ref<Eigen::MatrixXd> out);

}  // namespace cablefit
