// The position controller that computed a log's torque: the rig's, checked against the log, or one
// identified from the log.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "cablefit/base/axes.hpp"
#include "cablefit/samples/rows/equation_rows.hpp"

namespace cablefit {

/// How well a controller's law explains the measured torque.
struct ControllerFit {
  Controller controller;
  double misfit = 0;  ///< N m rms, of the torque by this law from reference and position
  double torque = 0;  ///< N m rms, of the measured torque about its mean
  double noise = 0;   ///< N m, sd of the measured torque's noise

  /// The misfit is within kControllerNoise of the noise plus kControllerShare of the torque, added
  /// in squares.
  bool fits() const;
  /// "kp 424 N m/rad, kd 5.1 N m s/rad; torque within 0.33 N m rms, 1.1 sd of its noise"
  std::string text(Axes axes) const;
};
inline constexpr double kControllerNoise = 2, kControllerShare = 0.05;

/// Torque misfit of the rig's controller on the wanted parts of the logs, one joint. None where a
/// log lacks the controller, its reference, theta or tau.
std::optional<ControllerFit> check_controller(std::span<const LogSurvey> logs,
                                              const PartFilter& wanted);

/// The simplest of PD, PID, velocity feedback, cascade and feed-forward laws (see Controller) whose
/// misfit is within kSimplerBy of that of the richest law. Fitted by least squares on the rows as
/// logged, with the torque acting at once, half a row or a row later. None where a log of one joint
/// lacks theta_ref, theta or tau, or where no law has positive gains.
std::optional<ControllerFit> fit_controller(std::span<const LogSurvey> logs,
                                            const PartFilter& wanted);
inline constexpr double kSimplerBy = 1.03;

}  // namespace cablefit
