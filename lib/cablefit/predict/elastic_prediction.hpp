// Elastic quantities of a model at measured positions. Internal to predict/.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "cablefit/model/model.hpp"
#include "cablefit/model/principal_copies.hpp"

namespace cablefit {

struct ElasticSignal {
  std::string name, unit;
};

class ElasticPrediction {
 public:
  /// `band`: half widths too, where the model knows a covariance of its elastic parameters.
  ElasticPrediction(const Model& model, bool band);

  /// Columns of what follows: tau_elas_l and tau_elas_m of every joint, elongation and tension of
  /// every cable, energy.
  const std::vector<ElasticSignal>& signals() const { return signals_; }
  bool has_band() const { return !copies_.empty(); }

  struct Rows {
    Eigen::MatrixXd values;       ///< rows x signals
    Eigen::MatrixXd half_widths;  ///< of the 95 % band; empty: not known
  };
  /// q, theta as logged, rows x joints.
  Rows rows(const Eigen::ArrayXXd& q, const Eigen::ArrayXXd& theta) const;

 private:
  Transmission transmission_;
  std::vector<MovedModel> copies_;
  std::vector<ElasticSignal> signals_;
};

}  // namespace cablefit
