// A test log simulated by the models before and after, beside what was measured. Internal to
// refine/.
#pragma once

#include <span>
#include <vector>

#include "cablefit/figure/figure.hpp"
#include "cablefit/model/model.hpp"
#include "cablefit/samples/survey/survey.hpp"

namespace cablefit {

/// What was not fitted.
struct TestLogs {
  std::span<const LogSurvey> logs = {};
  double compared = 1;  ///< share of the time of every log, its end
};

/// The deflection (theta of a rigid drive) of the first moving part that a model is of. Without
/// traces where nothing can be simulated. `after` empty: nothing was added.
Figure simulated_figure(const TestLogs& test, const std::vector<Model>& before,
                        const std::vector<Model>& after);

}  // namespace cablefit
