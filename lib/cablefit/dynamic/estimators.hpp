// The estimators of stage 2 as rows of a table. To add one: a file in estimators/ and one line in
// estimators.cpp.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "cablefit/dynamic/dynamic_job.hpp"
#include "cablefit/estimate/derived_quantity.hpp"

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

/// A row of the table (`cablefit list estimators`).
struct Estimator {
  std::string_view name;
  std::string_view description;
  std::string_view source;
  Estimation (*estimate)(const EstimationTask& task);
  bool by_filtered_rows = true;  ///< filter, differences and rounding bias it: method_floor.hpp
};

std::span<const Estimator> estimators();
/// Throws Error(usage) with a suggestion.
const Estimator& find_estimator(std::string_view name);

}  // namespace cablefit
