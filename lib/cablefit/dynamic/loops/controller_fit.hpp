// The position controllers that computed a log's torques: the rig's, checked against the log, or
// those identified from the log.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cablefit/base/axes.hpp"
#include "cablefit/samples/rows/equation_rows.hpp"

namespace cablefit {

/// How well the controller of one joint explains its measured torque.
struct ControllerFit {
  Controller controller;
  double misfit = 0;  ///< N m rms, of the torque by this law from reference and position
  double torque = 0;  ///< N m rms, of the measured torque about its mean
  double noise = 0;   ///< N m, sd of the measured torque's noise

  /// The misfit is within kControllerNoise of the noise plus kControllerShare of the torque, added
  /// in squares.
  bool fits() const;
  /// "kp 424 N m/rad, kd 5.1 N m s/rad; its torque is 0.33 N m rms from the measured one, 1.1 sd of
  /// the noise"
  std::string text(Axes axes) const;
};
inline constexpr double kControllerNoise = 2, kControllerShare = 0.05;

/// Of every joint, the first for joint 1.
struct ControllerFits {
  std::vector<ControllerFit> joints;

  bool all_fit() const;
  Controller controller() const;
  /// As that of one joint, of several with "joint 2: " before each. `only_wrong`: those that do not
  /// fit.
  std::string text(const JointAxes& axes, bool only_wrong = false) const;
};

/// Torque misfits of the rig's controller on the wanted parts of the logs. None where a log lacks
/// the controller, or theta_ref, theta or tau of a joint.
std::optional<ControllerFits> check_controllers(std::span<const LogSurvey> logs,
                                                const PartFilter& wanted);

/// Of every joint the simplest of PD, PID, velocity feedback, cascade and feed-forward laws (see
/// Controller) whose misfit is within kSimplerBy of that of the richest law. Fitted by least
/// squares on the rows as logged, with the torque acting at once, half a row or a row later. None
/// where a log lacks theta_ref, theta or tau of a joint, or where no law with positive gains
/// explains the torque of a joint, as of one that stands still.
std::optional<ControllerFits> fit_controllers(std::span<const LogSurvey> logs,
                                              const PartFilter& wanted);
inline constexpr double kSimplerBy = 1.03;

}  // namespace cablefit
