// The rows of an equation as figures show them: time, speed, load and residual of each. Internal to
// refine/.
#pragma once

#include <span>
#include <vector>

#include "cablefit/figure/figure.hpp"
#include "cablefit/refine/rows/design.hpp"
#include "cablefit/samples/survey/survey.hpp"

namespace cablefit {

/// One row of an equation for a figure.
struct ShownRow {
  double t;                       ///< s, on the common axis
  std::vector<double> variables;  ///< of regime_variables.hpp
  double residual;                ///< N m; N on a linear axis
};

/// The rows of one kind of all stretches, and their places on a grid for the autocorrelation.
struct ShownRows {
  std::vector<ShownRow> rows;
  std::vector<Eigen::Index> numbers;
  double row_period = 0;  ///< s, the largest of all stretches
  double rms = 0;
};

/// Start of each stretch on the common axis.
struct Timeline {
  std::vector<double> begins;
  double end = 0, spacing = 0;
  std::vector<Mark> marks;
};

/// For the stretches that have rows of the equation `wanted`; others take no time. `logs`: by
/// Stretch::log.
Timeline timeline_of(const Design& design, std::span<const LogSurvey> logs, RowKind wanted);

/// `x`: values of all columns.
ShownRows shown_rows(const Design& design, const Eigen::VectorXd& x, RowKind wanted,
                     const Timeline& time);

}  // namespace cablefit
