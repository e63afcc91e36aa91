// `cablefit predict`: a model evaluated along logs, without a simulation: elastic torques,
// elongations, tensions and energy of every row, (4) to (10) of Fichera & Grossard 2017; the torque
// that a sensor at the link would have shown; and when something pushed the link.
#pragma once

#include <span>
#include <string>

#include "cablefit/model/model.hpp"
#include "cablefit/predict/predict_result.hpp"
#include "cablefit/samples/survey/survey.hpp"

namespace cablefit {

struct PredictOptions {
  SampleOptions samples;     ///< of the equations of motion; and threads
  bool band = true;          ///< 95 % bands by the joint covariance
  std::string trajectories;  ///< CSV of the elastic quantities of every row; empty: none
  std::string sensed;        ///< CSV of the torques by the equations of motion; empty: none
  bool figures = false;      ///< for reports with plots
  double window = 0.05;      ///< s, of the contact detector
  double false_alarms_per_hour = 1;
  double detection_rate = 0.99;
  /// Moving logs of the model's preload without a contact, such as those of the fit: their residual
  /// is the detector's noise, and their alarms are false.
  std::span<const LogSurvey> quiet = {};
};

/// Every part of the logs (survey_for_simulation) by the model: one of stage 1 knows the elastic
/// quantities alone. Where a log has parts of the model's preload, only those. Throws Error(input)
/// for missing positions, Error(output) when a file cannot be written.
PredictResult predict_logs(const Model& model, std::span<const LogSurvey> logs,
                           const PredictOptions& options);

}  // namespace cablefit
