// Runs of rows without a gap, each as a whole: for what looks at all of them at once, or again and
// again. Memory grows with the run; for_each_window() (windows.hpp) needs little.
#pragma once

#include <Eigen/Core>
#include <functional>

#include "cablefit/samples/survey/survey.hpp"

namespace cablefit {

/// Evenly spaced rows without a gap, of one part of one log, as they were measured.
struct GaplessRows {
  std::size_t part = 0;  ///< index into LogSurvey::parts
  double t0 = 0;         ///< s, of the first row, on the clock of the log
  double period = 0;     ///< s
  Eigen::MatrixXd data;  ///< rows x LogPlan::slots, SI

  /// A joint's column; without rows where the log does not have it.
  Eigen::ArrayXd column(const LogPlan& plan, Channel channel, int joint) const;
};

/// The wanted parts of the log, in order. Runs shorter than `least_rows` are left out. `bridge`: as
/// of for_each_window().
void for_each_run(const LogSurvey& log, const std::function<bool(const PartSurvey&)>& wanted,
                  Eigen::Index least_rows, double bridge,
                  const std::function<void(GaplessRows&&)>& sink);

}  // namespace cablefit
