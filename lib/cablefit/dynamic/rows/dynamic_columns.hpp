// The equations of stage 2 as columns: effects of one side, elastic basis of every model in
// question, position (to see what an inertia could be confused with) and torque.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cablefit/dynamic/rows/added_effects.hpp"
#include "cablefit/elastic/elastic_result.hpp"
#include "cablefit/elastic/rows/elastic_columns.hpp"
#include "cablefit/estimate/solve/motion_advice.hpp"
#include "cablefit/model/arm.hpp"
#include "cablefit/model/effects.hpp"

namespace cablefit {

/// A column per coefficient of stage 1 and those of its misfit, which its error needs to be carried
/// on; or one column with the elastic torque.
enum class ElasticDetail { coefficients, torque };

/// Whose equation: of a joint (from 0) of an arm; no arm: the links do not move each other.
struct JointPlace {
  int joint = 0, n_joints = 1;
  const Arm* arm = nullptr;
};

/// The link equations of joints that move each other have the same columns, so that their rows can
/// stand under each other: base parameters of the arm, then each joint's effects, 0 in the rows of
/// the other joints.
struct DynamicColumns {
  Side side = Side::motor;
  JointPlace place;
  std::vector<DynamicParameter> parameters;  ///< of the first n_effects columns
  std::vector<const Effect*> effects;        ///< of this joint
  Eigen::Index n_arm = 0;                    ///< base parameters of the arm, the first columns
  Eigen::Index first_effect = 0;             ///< of this joint
  std::vector<AddedEffect> added;            ///< beyond (31), whose columns follow
  std::shared_ptr<const Transmission> cables = {};  ///< that these go by; none: a rigid drive
  Eigen::Index n_effects = 0;                       ///< all these columns, which come first
  ElasticDetail detail = ElasticDetail::coefficients;
  std::vector<Eigen::Index> elastic;  ///< first column of each elastic fit's basis, or its torque
  std::vector<Eigen::Index> n_elastic;
  /// Of each elastic fit the first of two columns: torque and loop of its misfit; -1: it has none.
  std::vector<Eigen::Index> misfit;
  Eigen::Index deflection = -1;  ///< theta - N q, for its range; -1 on a rigid drive
  Eigen::Index position = 0;     ///< q or theta
  Eigen::Index torque = 0;       ///< tau (motor, rigid) or tau_load (link)
  Eigen::Index count = 0;
};

/// What a joint has beyond (31), with the values about which nonlinear parameters are linearised,
/// and the cables that it goes by; none: those of the first fit.
struct AddedToJoint {
  std::span<const EffectInstance> effects = {};
  std::shared_ptr<const Transmission> cables = {};
};

/// Columns of one side for the given stage-1 fits (none on a rigid drive).
DynamicColumns dynamic_columns(Side side, const std::vector<const ElasticFit*>& fits,
                               ElasticDetail detail = ElasticDetail::coefficients,
                               const JointPlace& place = {}, const AddedToJoint& added = {});

/// `torque_held`: tau is then not averaged over the triangle. `has_load`: a tau_load signal exists.
Equation dynamic_equation(const DynamicColumns& columns, const std::vector<const ElasticFit*>& fits,
                          bool torque_held, double rest_speed);

/// The response as a combination of columns: tau - Z K on the motor side, tau_load + Z K on the
/// link side, for elastic fit number `which` (ignored on a rigid drive).
Eigen::VectorXd dynamic_response(const DynamicColumns& columns,
                                 const std::vector<const ElasticFit*>& fits, std::size_t which);

/// What the column of a parameter follows. The rows of several joints are weighted when they stand
/// under each other, so that their sizes say nothing.
MotionColumn motion_column(const DynamicColumns& columns, std::size_t parameter,
                           bool linear_motion);

/// Values of the effects' columns, written into those of `added` that have them, where they are
/// finite.
void take_values(const DynamicColumns& columns, const Eigen::VectorXd& x,
                 std::vector<EffectInstance>& added);

/// Coefficients of a stage-1 fit in the order of its basis columns.
Eigen::VectorXd elastic_coefficients(const ElasticFit& fit);

/// The first n_effects columns over full-rate rows, by the motion of place `joint` of the signals:
/// the equation's own joint, or a simulated copy of it.
void effect_columns(const DynamicColumns& columns, const Signals& signals, std::size_t joint,
                    Eigen::Ref<Eigen::MatrixXd> out);

}  // namespace cablefit
