// Estimates out of result files, whatever command wrote them: what a comparison needs.
#pragma once

#include <limits>
#include <set>
#include <string>
#include <vector>

#include "cablefit/base/json/json_document.hpp"
#include "cablefit/base/parameter.hpp"
#include "cablefit/samples/plan/input_file.hpp"

namespace cablefit {

/// Parameters that were fitted together.
struct EstimateSet {
  std::string stage;      ///< "stage 1", "stage 2", "one step"
  std::string preload;    ///< of a campaign: the cell; empty: they hold for every preload
  std::string model;      ///< "linear", "poly"; empty when there is one only
  std::string estimator;  ///< of stage 2
  int order = 0;  ///< of the cables of stage 1: coefficients of another order mean another thing
  bool is_selected = false;  ///< stage 1's choice of model
  /// What an offset and an encoder's zero are small or large against: rms torque of the motor (else
  /// the peak torque), half the range of deflections. NaN: unknown.
  double torque_scale = std::numeric_limits<double>::quiet_NaN();
  double deflection_scale = std::numeric_limits<double>::quiet_NaN();
  std::vector<Estimate> estimates = {};
};

struct RecordedResult {
  std::string path, version, command;
  std::vector<InputFile> inputs;  ///< what was fitted: logs, and earlier results (0 rows)
  std::vector<EstimateSet> sets;
};

/// Reads a result of `elastic`, `dynamic`, `identify` or `batch`. Throws Error(input) at
/// file:line:column.
RecordedResult read_recorded_result(const std::string& path);

/// Paths of the inputs that a result was only judged by: they did not go into its estimates.
std::set<std::string> validation_logs(const JsonNode& result);

}  // namespace cablefit
