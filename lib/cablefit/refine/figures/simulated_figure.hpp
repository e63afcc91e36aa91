// A test log and its simulation by the models before and after. Internal to refine/.
#pragma once

#include <span>
#include <vector>

#include "cablefit/figure/figure.hpp"
#include "cablefit/model/model.hpp"
#include "cablefit/samples/survey/survey.hpp"

namespace cablefit {

/// Logs that were not fitted.
struct TestLogs {
  std::span<const LogSurvey> logs = {};
  double compared = 1;  ///< share of the time of every log, at its end
};

/// The deflection (theta of a rigid drive) of the first moving part whose preload has a model.
/// Without traces where no simulation is possible. `after` empty: no effect was added.
Figure simulated_figure(const TestLogs& test, const std::vector<Model>& before,
                        const std::vector<Model>& after);

}  // namespace cablefit
