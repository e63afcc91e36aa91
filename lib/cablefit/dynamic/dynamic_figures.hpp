// Stage 2 as plots: measured and predicted torque, torque error (the paper's Figs. 8 and 9), and
// the residuals from all sides, per equation and model.
#pragma once

#include <vector>

#include "cablefit/dynamic/dynamic_result.hpp"
#include "cablefit/dynamic/rows/dynamic_job.hpp"
#include "cablefit/figure/figure.hpp"

namespace cablefit {

/// Streams the rows once more. solutions[model][equation] as fitted, models as in `preload.fits`.
std::vector<Figure> dynamic_figures(const DynamicJob& job,
                                    const std::vector<EquationRows>& equations,
                                    const std::vector<std::vector<LinearSolution>>& solutions,
                                    const DynamicPreload& preload);

/// The same for a single equation that has no torque in it (ratios.hpp): `residual` and `measured`
/// are combinations of its columns.
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
