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
  bool is_comparable = true;  ///< fitted rows of the same bin show what to expect
};

/// What holds for these rows; speeds are divided by the quartiles of the rows that were fitted.
std::vector<Condition> conditions(const JudgedRows& unseen, const JudgedRows& fitted,
                                  const std::vector<std::string>& logs);

/// Combinations of an equation's own columns.
struct JudgedModel {
  Eigen::VectorXd residual;  ///< what it leaves
  Eigen::VectorXd torque;    ///< what is to be explained
  Eigen::VectorXd linear;    ///< what the linear model leaves; empty: this is it
};

/// All rows, then every bin of every condition that has rows. A bin fails when its mean square
/// error exceeds that of the fitted rows by more than 3 sd of it (HAC over stretches of time) and
/// its rms by more than a quarter.
std::vector<ConditionError> condition_errors(const JudgedRows& unseen, const JudgedRows& fitted,
                                             const std::vector<Condition>& conditions,
                                             const JudgedModel& model);

}  // namespace cablefit
