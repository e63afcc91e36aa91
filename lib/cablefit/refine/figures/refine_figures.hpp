// A refinement as plots: what the equations leave before and after, over time and against what
// reveals the effect; candidates; how far the parameters moved.
#pragma once

#include <span>

#include "cablefit/refine/refine_result.hpp"
#include "cablefit/refine/rows/evidence.hpp"
#include "cablefit/samples/survey/survey.hpp"

namespace cablefit {

/// The same rows before anything was added and in the end, with the values of all columns.
struct BeforeAfter {
  std::span<const LogSurvey> logs;  ///< by Stretch::log
  const Design& before;
  const Eigen::VectorXd& x_before;
  const Design& after;
  const Eigen::VectorXd& x_after;
  KindLevels floor;  ///< N m, of these rows
};

/// Candidates and shifts, then all about the residuals of the logs that were fitted, and those of
/// the test logs over time.
std::vector<Figure> refine_figures(const RefineResult& result, const BeforeAfter& train,
                                   const BeforeAfter& test);

}  // namespace cablefit
