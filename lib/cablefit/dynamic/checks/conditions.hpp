// The conditions under which a model is judged: log, load, speed, direction, drive. Internal to
// dynamic/.
#pragma once

#include <string>
#include <vector>

#include "cablefit/dynamic/checks/judged_rows.hpp"
#include "cablefit/dynamic/validation_result.hpp"

namespace cablefit {

/// Rows sorted into bins of a column.
struct Condition {
  std::string name;
  Eigen::Index column = 0;
  double sign = 0;            ///< of the column; 0: its magnitude counts
  std::vector<double> edges;  ///< inner edges, ascending
  std::vector<std::string> labels;
  bool is_comparable = true;  ///< fitted rows of the same bin show which error to expect
};

/// The conditions of these rows. Speeds are divided by the quartiles of the fitted rows.
std::vector<Condition> conditions(const JudgedRows& unseen, const JudgedRows& fitted,
                                  const std::vector<std::string>& logs);

/// Combinations of an equation's own columns.
struct JudgedModel {
  Eigen::VectorXd residual;  ///< model residual
  Eigen::VectorXd torque;    ///< torque to be explained
  Eigen::VectorXd linear;    ///< residual of the linear model; empty: this is the linear model
};

/// All rows, then every bin of every condition that has rows. A bin fails when its mean square
/// error exceeds that of the fitted rows by more than 3 of its sd (HAC over stretches of time), and
/// its rms by more than a quarter.
std::vector<ConditionError> condition_errors(const JudgedRows& unseen, const JudgedRows& fitted,
                                             const std::vector<Condition>& conditions,
                                             const JudgedModel& model);

}  // namespace cablefit
