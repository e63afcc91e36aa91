// A fit judged: residual tests on its own logs, torque errors and residual tests on logs that it
// has not seen. Internal to dynamic/.
#pragma once

#include "cablefit/dynamic/checks/judged_rows.hpp"
#include "cablefit/dynamic/dynamic_result.hpp"

namespace cablefit {

/// What was fitted: solutions[model][equation], models as in `preload.fits`.
struct FittedModels {
  const DynamicJob& job;
  const std::vector<EquationRows>& equations;
  const std::vector<std::vector<LinearSolution>>& solutions;
};

/// Fills preload.residual_tests and, when the options name logs of this preload to validate on,
/// preload.validation.
void judge(const FittedModels& fitted, DynamicPreload& preload);

/// Throws Error(input) for a log to validate on whose preload was not fitted, that lacks a channel
/// or has other joints.
void require_judgeable(std::span<const LogSurvey> unseen, const std::vector<std::string>& preloads,
                       const LogSurvey& fitted, bool rigid);

}  // namespace cablefit
