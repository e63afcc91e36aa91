// The log that a planned motion would leave.
#pragma once

#include "cablefit/design/excitation/excited_motion.hpp"
#include "cablefit/samples/survey/windows.hpp"

namespace cablefit {

/// Without noise: q, theta, tau, and tau_load where the rig has no law of q. Its rig holds the
/// torque over a row. Throws Error(input) when the model's rig does not say how noisy its sensors
/// are.
LogSurvey planned_log(const Model& model, const ExcitedMotion& motion);

/// As it will be recorded, with one draw of the sensors' noise.
LogSurvey noisy_log(const Model& model, const ExcitedMotion& motion);

/// The motion as one window of such a log.
Window window_of(const ExcitedMotion& motion, const LogSurvey& log);

/// White noise of the sensors added; `draw`: number of the draw, each with a seed of its own.
Window with_noise(Window window, const LogSurvey& log, std::uint64_t draw);

}  // namespace cablefit
