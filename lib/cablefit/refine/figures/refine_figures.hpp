// A refinement as plots: what the equations leave before and after, over time and against what
// reveals the effect; candidates; how far the parameters moved.
#pragma once

#include <span>

#include "cablefit/refine/figures/simulated_figure.hpp"
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

/// The gap shrinking first: the residual against what reveals the effect, and a test log simulated.
/// Then candidates and shifts, all about the residuals of the logs that were fitted, and those of
/// the test logs over time.
std::vector<Figure> refine_figures(const RefineResult& result, const BeforeAfter& train,
                                   const BeforeAfter& test, const TestLogs& simulated = {});

}  // namespace cablefit
