// How well a fitted model predicts logs, as plain data for reports.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "cablefit/base/parameter.hpp"
#include "cablefit/base/window_mean.hpp"

namespace cablefit {

/// Torque error on the rows of one condition, N m (N on a linear axis).
struct ConditionError {
  std::string condition, value;  ///< "load", "-40 N m"
  std::size_t n_rows = 0;
  double rms = 0, mean = 0, max_abs = 0;
  double relative = 0;  ///< rms of the error over rms of the torque to be explained
  double zero = 0;      ///< rms of a model that predicts 0: that of the torque to be explained
  double linear = kNotKnown;  ///< rms of the linear model; NaN: this is it, or there is none
  double fitted = 0;          ///< rms on the fitted rows, of the same condition where they have it
  double floor = kNotKnown;   ///< rms of the best possible model; NaN: measured by log only
  bool fails = false;         ///< significantly and materially worse than `fitted`
  std::string verdict;        ///< "fails, 3.2 times" the rms in `fitted`

  double ratio() const { return fitted > 0 ? rms / fitted : 0; }
};

/// Result of a test of residuals. `material`: significant, and large enough to matter.
enum class Finding { nothing, immaterial, material, untestable };
std::string_view to_string(Finding finding);

struct ResidualTest {
  std::string name;       ///< "whiteness", "position q", "direction"
  std::string statistic;  ///< "Ljung-Box over 20 lags", "F(6, 212)"
  double value = 0;
  double p_value = 1;
  double structure = 0;  ///< N m rms of the structure found; 0 for whiteness
  Finding finding = Finding::nothing;
  std::string verdict;  ///< in words
};

/// One model and equation.
struct JudgedEquation {
  std::string model, equation;
  double noise_floor = 0;                  ///< rms of the best possible model, N m
  std::string floor_source;                ///< "repeats", "sensor noise"
  std::vector<ConditionError> conditions;  ///< empty for the logs that were fitted
  std::vector<ResidualTest> tests;
  double relative = 0;            ///< rms of the residual over rms of the torque to be explained
  std::vector<WindowMean> means;  ///< of the residual, for detectors that average; may be empty
  std::string headline;           ///< states that the model explains little, and the main cause
};

struct Validation {
  std::vector<std::string> logs;  ///< paths, as in the inputs of the result
  std::string linear_name;        ///< name of the linear baseline
  std::vector<JudgedEquation> equations;
};

}  // namespace cablefit
