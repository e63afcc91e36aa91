// The rows of the table of effects: one function per effect, each in its own file. Internal to
// effects.cpp; everybody else goes through effects().
#pragma once

#include "cablefit/model/effects.hpp"

namespace cablefit::rows {

/// J a: the inertia that the axis carries.
Effect inertia(Side side);
/// f_v v: friction proportional to speed.
Effect viscous(Side side);
/// f_s sgn(v): dry friction, the same level at rest and in motion.
Effect coulomb(Side side);
/// A constant torque on the motor (or on a rigid drive).
Effect offset(Side side);

/// f_s tanh(v / v_s): dry friction without stiction, as simulations smooth it.
Effect smooth_coulomb(Side side);

/// What differs between the sides of one effect.
template <typename T>
struct PerSide {
  T link, motor, rigid;

  constexpr const T& at(Side side) const {
    return side == Side::link ? link : side == Side::motor ? motor : rigid;
  }
};

}  // namespace cablefit::rows
