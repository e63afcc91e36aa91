// What a preload buys: torque curve, closure, stiffness, tensions, friction, and what simpler
// models of it cost, over a sweep of the initial elongation (Fichera & Grossard 2017: l_o kept in
// equilibrium (8c); sections 2.4 and 4).
#pragma once

#include <string>
#include <vector>

#include "cablefit/design/design_result.hpp"
#include "cablefit/model/model.hpp"

namespace cablefit {

struct DesignOptions {
  double torque = 0;        ///< N m, above 0: the joint works from -torque to torque
  std::vector<double> l_o;  ///< of the first cable; empty: chosen around what is needed
  std::vector<double> radius_factors = {1};
  std::vector<Eigen::VectorXd> held_loads;  ///< N m per joint, on the links, for hold_loads()
  std::vector<int> orders = {1};           ///< of the cables of simpler models; 1: piecewise linear
  std::optional<double> tension_friction;  ///< N m per N m, on the motor, beside the model's
  /// N m, of the torque, white; nothing: the link's residual of the fit, else the rig's sensor
  /// "tau".
  std::optional<double> noise;
  double floor = 0;  ///< N m, of what even the cables get wrong, bound; adds to every model's error
  double window = 0.05;  ///< s, of the collision detector
  double rate = 1000;    ///< Hz, of the same
  double false_alarms_per_hour = 1;
  double detection_rate = 0.99;
  std::vector<Model> fitted;                  ///< fits of several preloads; empty: the model alone
  std::optional<CollisionDetector> detector;  ///< made of these
  std::vector<FrictionCurve> friction;        ///< of the fits
  bool figures = false;
};

/// What every result says of the model: its names, and a warning where its own preload is not in
/// equilibrium.
DesignResult blank_design(const Model& model);

/// Throws Error(input) when the cables cannot be preloaded or never give the torque.
DesignResult sweep_design(const Model& model, const DesignOptions& options);

/// The links under each of options.held_loads at the model's own preload, at options.l_o or else at
/// the preloads of the sweep, with the rig's radii; and its figures. Throws Error(input) when the
/// cables do not hold a load.
void hold_loads(const Model& model, const DesignOptions& options, DesignResult& result);

/// Of the first cable, m (rad in joint space).
struct PreloadSearch {
  double l_o = 0;          ///< NaN when none is enough
  double searched_to = 0;  ///< what is beyond was not tried, or cannot be reached by a cable
};

/// Initial elongation at which all cables are just taut at -torque and torque on every joint (each
/// for itself), to 1e-12 of it.
PreloadSearch needed_preload(const Transmission& transmission, double torque);

/// What is known of one joint of cables that are preloaded already.
DesignJoint describe_joint(const Model& model, const Transmission& preloaded, int joint,
                           const DesignOptions& options);

}  // namespace cablefit
