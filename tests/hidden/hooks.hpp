// Where a hidden effect takes hold of the simulation. An effect fills in what it needs and leaves
// the rest empty.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "plant.hpp"

namespace hidden {

/// The middle of a step of length h.
struct State {
  double t = 0, h = 0;                              // s; t < 0 while the run settles
  double q = 0, qd = 0, theta = 0, thetad = 0;      // rad, rad/s
  double phi = 0, phid = 0;                         // theta - q, rad, rad/s
  double tau_elas = 0, tension = 0, stiffness = 0;  // N m, N m, N m/rad; filled in for `sides`
  double load = 0;                                  // N m
};

/// What resists one side besides inertia and viscous friction: a torque, and Coulomb friction as
/// the set [-down, up] (N m), of which it is `up` at positive speed, -down at negative speed, and
/// whatever keeps the side still at rest.
struct Side {
  double torque = 0, up = 0, down = 0;
  double viscous = 0;  ///< N m s/rad, taken implicitly
  double inertia = 0;  ///< kg m^2
};

struct Sides {
  Side link, motor;
};

struct Hooks {
  std::function<void(Bench&)> alter;                 ///< parameters, before the run
  std::function<double(const State&)> deflection;    ///< rad, added to phi for the cables
  std::function<double(const State&)> transmission;  ///< N m, added to tau_elas
  std::function<void(const State&, Sides&)> sides;   ///< whatever else resists
  std::function<void(const State&)> advance;         ///< inner states, once at the end of a step
  bool replaces_coulomb = false;                     ///< `sides` must run after all others
};

/// A number that an effect was given, e.g. {"v_s", 0.1, "rad/s"}; the first is the one that scales.
struct Coefficient {
  std::string name;
  double value = 0;
  std::string unit;
};

}  // namespace hidden
