// Models in another torque: with all that a factor of it moves. Internal to refine/.
#pragma once

#include <string>

#include "cablefit/model/model.hpp"

namespace cablefit {

/// By what a factor of all torques multiplies a parameter with this unit, "N m s/rad" or "kg m^2".
double torque_power(const std::string& unit, double factor);

/// The model of one joint, or of all, with every torque times `factor`: inertias, frictions,
/// stiffnesses, masses and their sd.
Model with_torque_times(Model model, double factor);

/// The model of one joint with everything beyond the motor in a torque `factor` times as large.
Model with_link_torque_times(Model one, double factor);

/// Whether a parameter is one of the motor's.
bool is_of_motor(const Model& one, const std::string& parameter);

}  // namespace cablefit
