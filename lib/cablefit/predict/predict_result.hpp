// Predictions of a model along logs, as plain data for reports. SI; on a linear axis read N for N m
// and m for rad.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cablefit/base/axes.hpp"
#include "cablefit/design/collision.hpp"
#include "cablefit/figure/figure.hpp"
#include "cablefit/samples/plan/input_file.hpp"
#include "cablefit/samples/rows/settings.hpp"

namespace cablefit {

/// One elastic quantity over the rows of a part.
struct PredictedSignal {
  std::string name;  ///< "tau_elas_l", "tau_elas_m", "elongation[1]", "tension[1]", "energy"
  std::string unit;
  double least = 0, largest = 0;
  /// Of the 95 % band by the joint covariance of the elastic parameters, rms over the rows;
  /// nothing: the covariance is not known.
  std::optional<double> half_width = {};
};

/// A torque by the model beside the sensor of the log; without one the torque itself.
struct SensedTorque {
  std::string signal;  ///< "tau", "tau_load"; of several joints "tau2"
  std::string unit;
  std::string method;       ///< "tau_elas_m + offset, link at rest", "equation of the link"
  bool is_measured = true;  ///< false: rms and largest are those of the torque
  std::size_t n_rows = 0;
  double rms = 0, max_abs = 0, t_of_max = 0;  ///< model minus sensor; s
  double relative = 0;                        ///< rms / rms of the sensor; NaN: not measured
};

/// Windows side by side in which the link was pushed.
struct Contact {
  double from = 0, to = 0;  ///< s
  double torque = 0;        ///< N m, on the link: mean of the window that shows the largest
};

/// The link's residual watched for contacts (design/collision.hpp).
struct ContactWatch {
  std::string joint;
  double window = 0;  ///< s
  CollisionThreshold detector;
  std::string noise_source;  ///< where the sd of a window's mean comes from
  std::size_t n_windows = 0, n_alarms = 0;
  double expected_alarms = 0;      ///< among so many windows without a contact
  double seconds_not_watched = 0;  ///< the link stands still: dry friction hides any torque
  /// Among logs without a contact that were given; nothing: none were.
  std::optional<std::size_t> quiet_windows = {}, false_alarms = {};
  std::vector<Contact> contacts;
};

/// One part (preload, phase, run) of one log.
struct PredictedPart {
  std::string log, preload, phase, run;
  std::size_t n_rows = 0;
  WindowCounts counts;
  std::vector<PredictedSignal> signals;
  std::vector<SensedTorque> torques;
  std::vector<ContactWatch> watches;  ///< one per joint; empty: its link does not move, or cannot
                                      ///< be predicted
  std::vector<Decision> decisions;
  std::vector<std::string> warnings;
  std::vector<Figure> figures;
};

struct PredictResult {
  std::vector<InputFile> inputs;  ///< the logs; the command puts the model before them
  std::string model_path, model_choice, model_name, preload;
  std::string rig_path;  ///< the model's; empty: the default rig
  Axes axes = Axes::rotary;
  std::vector<PredictedPart> parts;
  std::string trajectories, sensed;  ///< files, empty: none
  std::vector<std::string> warnings;
};

}  // namespace cablefit
