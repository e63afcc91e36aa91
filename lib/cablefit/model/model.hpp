// A model (cablefit/model/1): rig, effects per axis, cables, and every parameter with value and sd.
// `simulate` runs it and `refine` extends it.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cablefit/base/parameter.hpp"
#include "cablefit/base/parameter_covariance.hpp"
#include "cablefit/base/window_mean.hpp"
#include "cablefit/model/cables.hpp"
#include "cablefit/model/effects.hpp"
#include "cablefit/model/rig.hpp"

namespace cablefit {

/// Name of a joint's parameter in results: "f_v", or "f_v[2]" when there are several joints.
std::string joint_parameter_name(std::string_view name, int joint, int n_joints);
/// A base effect's parameter of joint `joint` (from 1) without a value: name, symbol and unit.
Estimate blank_estimate(const ParameterInfo& parameter, int joint, const Rig& rig);

/// Finds the estimate of a parameter by its blank estimate; nothing: the model does not have it.
using FindEstimate = std::function<std::optional<Estimate>(const Estimate& blank)>;
/// The base effects of one side of a joint (from 1) whose parameter `find` finds.
std::vector<EffectInstance> base_instances(Side side, int joint, const Rig& rig,
                                           const FindEstimate& find);

struct JointModel {
  std::vector<EffectInstance> link;   ///< empty on a rigid drive
  std::vector<EffectInstance> motor;  ///< for a rigid drive the effects of Side::rigid
  /// Beyond (31). The cables of the model already have its `change` rows.
  std::vector<EffectInstance> added = {};
  /// The logs of this joint do not separate the cables that another joint's motor winds. refine
  /// does not fit their coefficients here.
  bool holds_passing_cables = false;
};

struct Model {
  // Compiled once in model.cpp, not in every file that copies or destroys one.
  Model();
  Model(const Model&);
  Model(Model&&) noexcept;
  Model& operator=(const Model&);
  Model& operator=(Model&&) noexcept;
  ~Model();

  std::string name;  ///< "poly", "linear", "rigid"
  std::string preload;
  Rig rig;
  std::vector<JointModel> joints;
  Transmission transmission;  ///< with coefficients; unused on a rigid drive
  /// Stage-1 parameters with their sd, for the file: the coefficients of every cable (or K), then
  /// l_o and theta_0 if estimated, then other results of stage 1 (offset, f_sm).
  std::vector<Estimate> elastic;
  bool rigid = false;
  /// Of the parameters of its effects and cables; empty: not known.
  ParameterCovariance covariance = {};
  /// Window means of the link equation's residual in the fit (window_mean.hpp), N m; empty: not
  /// known.
  std::vector<WindowMean> link_residual = {};
  /// Base parameters of a coupled arm, in its order (arm.hpp). Its links have no J_link of their
  /// own. Empty: every link moves its own inertia, or the drive is rigid.
  std::vector<Estimate> arm = {};
  /// For one joint taken from a model of several (one_joint.hpp): the original model, and the
  /// joint's index from 0. nullptr: this model is the original.
  std::shared_ptr<const Model> whole = nullptr;
  int joint = 0;

  /// The links are coupled.
  bool is_coupled() const { return !arm.empty(); }
};

/// The model's name when no fit gave one: "rigid", "linear" or "poly".
std::string_view default_model_name(const Model& model);

/// The text of a cablefit/model/1 file.
std::string model_json(const Model& model);

}  // namespace cablefit
