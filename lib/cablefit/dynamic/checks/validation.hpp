// Judges a fit: residual tests on its own logs, torque errors and residual tests on held-out logs.
// Internal to dynamic/.
#pragma once

#include "cablefit/dynamic/checks/judged_rows.hpp"
#include "cablefit/dynamic/dynamic_result.hpp"

namespace cablefit {

/// The fitted models: solutions[model][equation], models as in `preload.fits`.
struct FittedModels {
  const DynamicJob& job;
  const std::vector<EquationRows>& equations;
  const std::vector<std::vector<LinearSolution>>& solutions;
};

/// Fills preload.residual_tests. Also fills preload.validation when the options give validation
/// logs of this preload.
void judge(const FittedModels& fitted, DynamicPreload& preload);

/// Throws Error(input) for a validation log whose preload was not fitted, that lacks a channel, or
/// that has other joints.
void require_judgeable(std::span<const LogSurvey> unseen, const std::vector<std::string>& preloads,
                       const LogSurvey& fitted, bool rigid);

}  // namespace cablefit
