// What every estimator of stage 2 works on, and what it gives.
#pragma once

#include <optional>
#include <vector>

#include "cablefit/dynamic/rows/dynamic_job.hpp"
#include "cablefit/estimate/fit/derived_quantity.hpp"

namespace cablefit {

/// What an estimator works on: one model of one preload.
struct EstimationTask {
  const DynamicJob& job;
  const std::vector<EquationRows>& equations;  ///< with their rows
  std::size_t model;                           ///< place among job.models and job.elastic

  /// Stage 1 of this model; nullptr for a rigid drive.
  const ElasticFit* stage1() const { return job.rigid ? nullptr : job.elastic[model]; }
};

struct Estimation {
  DynamicFit fit;
  /// Per equation: what rows * residual_combination = residual is needed for, largest errors and
  /// plots.
  std::vector<LinearSolution> solutions;
  std::vector<Decision> decisions;           ///< what was chosen on the way, with the reason
  std::optional<JointEstimates> joint = {};  ///< for derived quantities, where they are known
};

}  // namespace cablefit
