// What a sweep of the preload found, as plain data for reports. SI; on a linear axis read N for N m
// and m for rad.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cablefit/base/axes.hpp"
#include "cablefit/base/parameter.hpp"
#include "cablefit/design/collision.hpp"
#include "cablefit/design/excitation/excitation_plan.hpp"
#include "cablefit/design/friction_curves.hpp"
#include "cablefit/design/loads/held_load.hpp"
#include "cablefit/design/loads/pose_stiffness.hpp"
#include "cablefit/design/loads/torque_polytope.hpp"
#include "cablefit/figure/figure.hpp"
#include "cablefit/samples/plan/input_file.hpp"
#include "cablefit/samples/rows/settings.hpp"

namespace cablefit {

/// What a user pays for a model of the elastic torque that is simpler than the cables.
struct ModelCost {
  std::string model;                 ///< "linear", "piecewise linear", "order 3", "cables"
  std::vector<double> coefficients;  ///< K (N m/rad), or those of every cable
  double max_error = 0;              ///< N m, largest on the working range
  double rms_error = 0;              ///< N m
  double at = 0;                     ///< rad, deflection of the largest error
  double static_error = 0;           ///< rad, error of the joint's position under load
  /// Hz, the model's resonance over the range; NaN without inertias.
  double resonance_low = kNotKnown, resonance_high = kNotKnown;
  std::optional<CollisionThreshold> collision;  ///< nothing without a noise of the torque
};

/// Dry friction and what it costs, at one torque.
struct DesignFriction {
  double at_rest = 0;              ///< N m, with no load
  double driving = 0, driven = 0;  ///< N m, at the torque: lifting it, and giving way to it
  double efficiency_driving = 0;   ///< torque / (torque + friction)
  double efficiency_driven = 0;    ///< (torque - friction) / torque, 0: it locks
  double sd = kNotKnown;           ///< N m, of all three levels, by the fitted preloads
  double low = kNotKnown, high = kNotKnown;                        ///< 95 % interval of `at_rest`
  double efficiency_low = kNotKnown, efficiency_high = kNotKnown;  ///< of `efficiency_driving`
  struct Part {
    std::string name, unit;
    FrictionValue value;
  };
  std::vector<Part> parts;  ///< f_s, f_v, ... at this preload, by the fitted preloads
};

struct TensionRange {
  std::string cable;
  double preload = 0;             ///< N (joint space: N m), without load
  double least = 0, largest = 0;  ///< on the working range
};

/// sd of numbers of a DesignJoint, by the joint covariance of the model's parameters; NaN: not
/// known.
struct DesignSpread {
  double closure_torque = kNotKnown;                             ///< N m
  double stiffness_zero = kNotKnown;                             ///< N m/rad
  double stiffness_low = kNotKnown, stiffness_high = kNotKnown;  ///< N m/rad
  double efficiency_driving = kNotKnown;
};

struct DesignJoint {
  std::string name;
  double low = 0, high = 0;  ///< rad, working range: deflections at -torque and +torque
  double closure_low = 0, closure_high = 0;  ///< rad, all cables taut between; may be infinite
  double closure_torque_low = 0, closure_torque_high = 0;  ///< N m
  double closure_torque = 0;  ///< N m, up to which all are taut in both directions
  std::string slack_first;    ///< the cable that goes slack first; empty: none does
  double stiffness_zero = 0;  ///< N m/rad, without load; of slack cables the mean of both sides
  double stiffness_low = 0, stiffness_high = 0;    ///< at -torque and +torque
  double stiffness_least = 0, stiffness_most = 0;  ///< on the range
  std::vector<TensionRange> tensions;
  std::vector<ModelCost> models;           ///< linear, piecewise linear, ..., cables
  std::optional<DesignFriction> friction;  ///< nothing where it is not known
  std::optional<DesignSpread> sd;          ///< nothing when the model has no covariance
  const ModelCost& model(const std::string& which) const;
};

/// One design: a preload, and pulleys.
struct DesignPoint {
  double l_o = 0;                           ///< of the first cable
  double radius_factor = 1;                 ///< times the rig's radii
  std::vector<double> initial_elongations;  ///< per cable, balanced (8c)
  std::vector<DesignJoint> joints;
  bool is_own = false;  ///< the preload that the model has
  std::string preload;  ///< name of a fitted preload with its own cables; empty: of the sweep
};

/// The smallest preload that keeps all cables taut up to the torque, in both directions.
struct NeededPreload {
  double radius_factor = 1;
  double l_o = kNotKnown;                   ///< of the first cable; NaN: no preload does
  double searched_to = 0;                   ///< largest l_o of the first cable that was tried
  std::vector<double> initial_elongations;  ///< per cable
  std::vector<double> tensions;             ///< per cable, without load
};

struct DesignResult {
  std::vector<InputFile> inputs;
  std::string model_path, model_choice, model_name, preload;
  Axes axes = Axes::rotary;
  bool cable_space = false;
  std::vector<std::string> cables;
  double torque = 0;                          ///< N m, the working range is -torque .. torque
  std::optional<CollisionDetector> detector;  ///< of the cables themselves
  double false_alarms_per_hour = 0;
  std::vector<DesignPoint> points;
  std::vector<DesignPoint> fitted;        ///< two or more fitted preloads, as they were fitted
  std::vector<FrictionCurve> friction;    ///< by these; empty: none are known
  std::vector<NeededPreload> needed;      ///< one per radius factor
  std::vector<PoseStiffness> stiffness;   ///< where asked for
  std::optional<StiffnessAlong> along;    ///< a log, where asked for
  std::optional<Balance> balance;         ///< of the model's own preload, where asked for
  std::vector<TorquePolytope> polytopes;  ///< of the links' torques, where asked for
  double largest_tension = 0;             ///< N (joint space: N m), of these; 0: none
  std::vector<SlackOrder> slack_orders;   ///< with these: both directions of each joint
  std::vector<HeldLoad> held;             ///< where asked for: preload by preload, load by load
  std::optional<ExcitationPlan> excitation;
  std::string excitation_path;  ///< of its reference
  std::vector<Decision> decisions;
  std::vector<std::string> warnings;
  std::vector<Figure> figures;
};

}  // namespace cablefit
