// Input and result of every estimator of stage 2.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cablefit/dynamic/rows/dynamic_job.hpp"
#include "cablefit/estimate/fit/derived_quantity.hpp"

namespace cablefit {

/// Input of an estimator: one model of one preload.
struct EstimationTask {
  const DynamicJob& job;
  const std::vector<EquationRows>& equations;  ///< with their rows
  std::size_t model;                           ///< place among job.models and job.elastic

  /// Stage 1 of this model; nullptr for a rigid drive.
  const ElasticFit* stage1() const { return job.rigid ? nullptr : job.elastic[model]; }
  /// "controller"; of several models "controller, poly".
  std::string decision_name(const std::string& what) const {
    return job.models.size() < 2 ? what : what + ", " + job.models[model];
  }
};

struct Estimation {
  DynamicFit fit;
  /// Per equation: rows * residual_combination = residual, for the largest errors and plots.
  std::vector<LinearSolution> solutions;
  std::vector<Decision> decisions;           ///< choices of the estimator, with the reason
  std::optional<JointEstimates> joint = {};  ///< for derived quantities, where they are known
  /// How the estimator itself measured fit.method_floor, or why it could not; empty: it did not.
  std::string floor_note = {};
};

}  // namespace cablefit
