// Options of stage 2.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cablefit/model/effects.hpp"
#include "cablefit/samples/rows/settings.hpp"
#include "cablefit/samples/survey/survey.hpp"

namespace cablefit {

/// A row of the table of models of stage 2 (`cablefit list models`).
struct DynamicModel {
  std::string_view name;
  std::string_view equation;
  std::string_view source;
  bool elastic;  ///< needs stage 1
};
std::span<const DynamicModel> dynamic_models();

struct DynamicOptions {
  SampleOptions samples;
  std::vector<std::string> models = {"poly"};  ///< names of the table
  std::string estimator = "auto";              ///< name of the table (estimators.hpp)
  bool robust_sd = true;                       ///< --sd honest | white
  std::string preload;                         ///< only this one; empty: all preloads
  /// Effects beyond the paper's (31), with start values. They require exactly one model.
  EffectsPerJoint effects = {};
  bool figures = false;        ///< one more pass, for reports with plots
  bool residual_tests = true;  ///< tests of up to 40 windows of every log
  bool sweep = false;          ///< also fit with other cut-offs and rest speeds
  /// The method's floor by parameter, where it is already known; none: it is measured.
  std::optional<std::map<std::string, double>> method_floor = {};
  /// s, memory of the estimators `recursive` and `gradient`; 0: `recursive` forgets nothing.
  double memory = 0;
  std::vector<LogSurvey> validation = {};  ///< logs to judge the fit on; they are not fitted
};

}  // namespace cablefit
