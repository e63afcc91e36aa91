// Models in another torque: with all that a factor of it moves. Internal to refine/.
#pragma once

#include <string>

#include "cablefit/model/model.hpp"

namespace cablefit {

/// A factor of all torques, with its own relative sd.
struct TorqueFactor {
  double value = 1, relative_sd = 0;

  /// By what it multiplies a parameter with this unit, "N m s/rad" or "kg m^2".
  double of(const std::string& unit) const;
  void scale(Estimate& e) const;
};

/// The model of one joint, or of all, with everything beyond the motors in another torque: links,
/// cables, masses, and what effects are a share of. Motors keep the torque of their logs.
Model with_link_torque(Model model, const TorqueFactor& factor);

/// Whether an effect acts on the motor, and a parameter is one of the motor's.
bool is_of_motor(const Effect& row);
bool is_of_motor(const Model& one, const std::string& parameter);

}  // namespace cablefit
