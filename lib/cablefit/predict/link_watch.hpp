// The torques by the equations of motion of moving logs, and the contacts that the link's residual
// shows. Internal to predict/.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "cablefit/predict/predict.hpp"
#include "cablefit/predict/prediction_files.hpp"
#include "cablefit/predict/window_series.hpp"

namespace cablefit {

class LinkWatch {
 public:
  /// Looks at the logs without a contact, where options name some. Both must outlive it. A model of
  /// stage 1 has no equations of motion: then nothing is added. Throws Error(input) when options
  /// ask such a model for torques of a sensor or for contacts.
  LinkWatch(const Model& model, const PredictOptions& options);

  /// `parts`: of the log number `number` (from 1), one for each that is wanted. What cannot be
  /// predicted is said in their decisions.
  void add(const LogSurvey& log, const std::vector<bool>& wanted, std::size_t number,
           std::vector<PredictedPart>& parts);
  void finish();

 private:
  void look_at(const LogSurvey& log, const std::vector<bool>& wanted, std::size_t number,
               std::vector<PredictedPart>& parts);

  const Model& model_;
  const PredictOptions& options_;
  bool moves_ = false;                                  ///< the model has the equations of motion
  std::vector<std::vector<WindowSeries::Mean>> quiet_;  ///< by joint
  std::optional<SensedFile> file_;
};

}  // namespace cablefit
