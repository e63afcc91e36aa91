// Plots of a refinement: residuals before and after, over time and against the variable that shows
// the effect; candidates; changes of the parameters.
#pragma once

#include <span>

#include "cablefit/refine/figures/simulated_figure.hpp"
#include "cablefit/refine/refine_result.hpp"
#include "cablefit/refine/rows/evidence.hpp"
#include "cablefit/samples/survey/survey.hpp"

namespace cablefit {

/// The same rows before any effect was added and at the end, with the values of all columns.
struct BeforeAfter {
  std::span<const LogSurvey> logs;  ///< by Stretch::log
  const Design& before;
  const Eigen::VectorXd& x_before;
  const Design& after;
  const Eigen::VectorXd& x_after;
  KindLevels floor;  ///< N m, of these rows
};

/// First the residual against the variable that shows the effect, and a simulated test log. Then
/// candidates and changes of parameters. At the end the residuals of the fitted logs, and those of
/// the test logs over time.
std::vector<Figure> refine_figures(const RefineResult& result, const BeforeAfter& train,
                                   const BeforeAfter& test, const TestLogs& simulated = {});

}  // namespace cablefit
