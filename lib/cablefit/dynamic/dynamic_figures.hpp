// Plots of stage 2 per equation and model: measured and predicted torque, torque error (the paper's
// Figs. 8 and 9), and residuals against each variable.
#pragma once

#include <vector>

#include "cablefit/dynamic/dynamic_result.hpp"
#include "cablefit/dynamic/rows/dynamic_job.hpp"
#include "cablefit/figure/figure.hpp"

namespace cablefit {

/// Needs one more pass over the rows. solutions[model][equation] as fitted, models as in
/// `preload.fits`.
std::vector<Figure> dynamic_figures(const DynamicJob& job,
                                    const std::vector<EquationRows>& equations,
                                    const std::vector<std::vector<LinearSolution>>& solutions,
                                    const DynamicPreload& preload);

/// As above, for a single equation without a torque (ratios.hpp). `residual` and `measured` are
/// combinations of its columns.
struct RatioRows {
  std::span<const LogSurvey> logs;
  const PartFilter& wanted;
  const RowSettings& settings;
  int threads = 1;
  const Equation& equation;
  Eigen::VectorXd measured, residual;
  double rms = 0;
};
std::vector<Figure> ratio_figures(const RatioRows& rows, const DynamicPreload& preload);

}  // namespace cablefit
