// The equations of stage 2 as columns: effects of one side, elastic basis of every model, position
// (to see what an inertia could be confused with) and torque.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cablefit/base/axes.hpp"
#include "cablefit/dynamic/rows/added_effects.hpp"
#include "cablefit/elastic/elastic_result.hpp"
#include "cablefit/elastic/rows/elastic_columns.hpp"
#include "cablefit/estimate/solve/motion_advice.hpp"
#include "cablefit/model/arm.hpp"
#include "cablefit/model/effects.hpp"

namespace cablefit {

/// A column per coefficient of stage 1 and those of its misfit, which are needed to propagate its
/// error; or one column with the elastic torque.
enum class ElasticDetail { coefficients, torque };

/// The joint (from 0) of an equation, and its arm; nullptr: the links are not coupled.
struct JointPlace {
  int joint = 0, n_joints = 1;
  const Arm* arm = nullptr;
  JointAxes axes = {};
};

/// The link equations of coupled joints have the same columns, so that their rows can be stacked:
/// base parameters of the arm, then each joint's effects, and those beyond (31); 0 in the rows of
/// the other joints.
struct DynamicColumns {
  Side side = Side::motor;
  JointPlace place;
  std::vector<DynamicParameter> parameters;  ///< of the first n_effects columns
  std::vector<const Effect*> effects;        ///< of this joint
  Eigen::Index n_arm = 0;                    ///< base parameters of the arm, the first columns
  Eigen::Index first_effect = 0;             ///< of this joint
  std::vector<AddedEffect> added;            ///< effects beyond (31), joint by joint
  Eigen::Index first_added = 0;              ///< their columns follow
  std::shared_ptr<const Transmission> cables = {};  ///< of these effects; none: a rigid drive
  Eigen::Index n_effects = 0;  ///< number of all these columns, which come first
  ElasticDetail detail = ElasticDetail::coefficients;
  std::vector<Eigen::Index> elastic;  ///< first column of each elastic fit's basis, or its torque
  std::vector<Eigen::Index> n_elastic;
  /// For each elastic fit the first of two columns, torque and loop of its misfit; -1: it has none.
  std::vector<Eigen::Index> misfit;
  Eigen::Index deflection = -1;  ///< theta - N q, for its range; -1 on a rigid drive
  Eigen::Index position = 0;     ///< q or theta
  Eigen::Index torque = 0;       ///< tau (motor, rigid) or tau_load (link)
  Eigen::Index count = 0;
};

/// Effects beyond (31) of every joint, or none, with the values at which nonlinear parameters are
/// linearised, and the cables that they depend on. No cables: those of the first fit.
struct AddedEffects {
  const EffectsPerJoint* effects = nullptr;
  std::shared_ptr<const Transmission> cables = {};
};

/// Columns of one side for the given stage-1 fits (none on a rigid drive).
DynamicColumns dynamic_columns(Side side, const std::vector<const ElasticFit*>& fits,
                               ElasticDetail detail = ElasticDetail::coefficients,
                               const JointPlace& place = {}, const AddedEffects& added = {});

/// `torque_held`: tau is not averaged over the triangle.
Equation dynamic_equation(const DynamicColumns& columns, const std::vector<const ElasticFit*>& fits,
                          bool torque_held, double rest_speed);

/// The response as a combination of columns: tau - Z K on the motor side, tau_load + Z K on the
/// link side, for elastic fit number `which` (ignored on a rigid drive).
Eigen::VectorXd dynamic_response(const DynamicColumns& columns,
                                 const std::vector<const ElasticFit*>& fits, std::size_t which);

/// The part of the motion that the column of a parameter follows. Stacked rows of several joints
/// are weighted, so their sizes do not describe the motion.
MotionColumn motion_column(const DynamicColumns& columns, std::size_t parameter);

/// Writes finite values of the effects' columns into the members of `added`.
void take_values(const DynamicColumns& columns, const Eigen::VectorXd& x, EffectsPerJoint& added);

/// Coefficients of a stage-1 fit in the order of its basis columns.
Eigen::VectorXd elastic_coefficients(const ElasticFit& fit);

/// The first n_effects columns over full-rate rows, from the motion at place `joint` of the
/// signals: the equation's own joint, or a simulated copy of it.
void effect_columns(const DynamicColumns& columns, const Signals& signals, std::size_t joint,
                    Eigen::Ref<Eigen::MatrixXd> out);

}  // namespace cablefit
