// A reference trajectory and what the drive makes of it, within limits.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "cablefit/model/model.hpp"
#include "cablefit/simulate/simulator.hpp"

namespace cablefit {

/// Of every joint, and of motor and link alike.
struct ExcitationLimits {
  double max_position = 0;  ///< rad, from `middle`
  double max_speed = 0;     ///< rad/s
  double max_torque = 0;    ///< N m, of the motor
  double duration = 16;     ///< s
  double rate = 1000;       ///< Hz, of the rows
  double middle = 0;        ///< rad
  double load = 0;          ///< N m, constant on the links, where the rig has no law of q
};

/// A motion that was simulated in closed loop, without noise.
struct ExcitedMotion {
  double period = 0;          ///< s
  Eigen::ArrayXXd theta_ref;  ///< rad, rows x joints
  SimulationInput input;
  SimulationResult result;
  /// Largest shares of the limits that motor, link and torque came to, at most 1.
  double position_share = 0, speed_share = 0, torque_share = 0;
};

/// The model with a controller to simulate with: the rig's, else a surrogate controller that
/// follows its reference as fast as the motor's inertia allows (`words` says which). Throws
/// Error(input) for a model without inertias, which cannot be simulated.
Model excitable(const Model& model, double rate, std::string& words);

/// The state in which a motion begins: at rest around the middle, cables and controller holding the
/// load and the weight of an arm. Several joints, which cables may couple, are left to come to rest
/// there for 2 s, in steps of `step` (s).
SimulationInput at_rest(const Model& model, const ExcitationLimits& limits, double step);

/// Largest share of a scaled reference at which no limit is broken, by the simulation itself: from
/// `start`, `shape` (rows x joints, around 0) times a factor, at most `share` of the
/// limits of position and speed. Nothing when even the equilibrium breaks one, or the loop is
/// unstable. `step`: s, of the simulation.
std::optional<ExcitedMotion> motion_within(const Model& model, const ExcitationLimits& limits,
                                           const SimulationInput& start,
                                           const Eigen::ArrayXXd& shape, double share, double step);

}  // namespace cablefit
