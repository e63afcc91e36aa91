// Effects that a model has beyond those of (31), as columns of an equation of stage 2: whatever
// `refine` may find, from its row of the catalogue.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cablefit/model/effects.hpp"
#include "cablefit/model/motion_part.hpp"
#include "cablefit/model/refinements.hpp"
#include "cablefit/samples/rows/signals.hpp"

namespace cablefit {

/// What one of the first columns is the torque per unit of.
struct DynamicParameter {
  ParameterInfo info;
  std::string name;             ///< with the joint's index when there are several
  bool is_inertia = false;      ///< of one axis
  std::optional<double> given;  ///< by the rig file, and not estimated
  MotionPart follows = MotionPart::several;
  /// The column's parameter is the distance from here: that of a nonlinear one.
  double origin = 0;
};

/// An effect in one equation. Linear parameters have a column each. A nonlinear one has the torque
/// by which the equation changes per unit of it, about the value of `instance`. Both sides of the
/// transmission have what acts between them: it is held at the values of `instance`.
struct AddedEffect {
  RefinementInstance instance;
  Side side = Side::motor;
  bool is_held = false;
  std::vector<std::size_t> moving_shapes;  ///< with a column: continuous, and looked for

  Eigen::Index n_columns() const;
};

/// Those of `instances` that act in an equation of this side. Throws Error(usage) for what is no
/// torque: an error of a sensor or of the drive has to be mended in the log or its rig file.
std::vector<AddedEffect> effects_of_side(std::span<const RefinementInstance> instances, Side side);

/// What the columns of an effect are.
std::vector<DynamicParameter> parameters_of(const AddedEffect& effect);

/// Its columns over full-rate rows. `cables`: nullptr on a rigid drive.
void fill_columns(const AddedEffect& effect, const Transmission* cables, const Signals& signals,
                  std::size_t joint, Eigen::Ref<Eigen::MatrixXd> out);

}  // namespace cablefit
