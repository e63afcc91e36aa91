// The elastic quantities of one part of a log, window by window. Internal to predict/.
#pragma once

#include <vector>

#include "cablefit/predict/elastic_prediction.hpp"
#include "cablefit/predict/predict_result.hpp"
#include "cablefit/predict/torque_scan.hpp"
#include "cablefit/samples/rows/time_axis.hpp"
#include "cablefit/samples/survey/windows.hpp"

namespace cablefit {

class PartPrediction {
 public:
  /// All must outlive it. `offset`: of every motor, N m; what it takes beside tau_elas_m to hold
  /// the link still.
  PartPrediction(const ElasticPrediction& prediction, const LogSurvey& log, const PartSurvey& part,
                 const Eigen::VectorXd& offset);

  /// The rows of a window, and where they begin.
  const ElasticPrediction::Rows& add(const Window& window);
  PredictedPart result(bool figures) const;

 private:
  void scan(const Window& window);
  void sense(const Window& window, const Eigen::ArrayXXd& tau);
  std::vector<Figure> figures() const;

  const ElasticPrediction& prediction_;
  const LogSurvey& log_;
  const PartSurvey& part_;
  Eigen::VectorXd offset_;
  ElasticPrediction::Rows rows_;
  std::size_t n_rows_ = 0;
  Eigen::RowVectorXd least_, largest_, squared_widths_;
  std::vector<TorqueScan> at_rest_;  ///< by joint; of a blocked link
  TimeAxis time_;
  std::vector<ThinnedLine> lines_;  ///< tau_elas_l and tau_elas_m of every joint
};

}  // namespace cablefit
