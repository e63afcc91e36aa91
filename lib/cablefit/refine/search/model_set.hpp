// The models that a refinement starts from, one per preload.
#pragma once

#include <span>
#include <vector>

#include "cablefit/model/model.hpp"
#include "cablefit/samples/survey/survey.hpp"

namespace cablefit {

/// Throws Error(usage) for two models of one preload, for models with different equations (they
/// must share coefficients), and for an event among the kept effects of a model. Other kept effects
/// are part of the equations.
void require_model_set(std::span<const Model> models);

/// The models whose preload is in the logs. All of them when none is, so that the mismatch is
/// reported.
std::vector<Model> models_with_logs(std::vector<Model> models, std::span<const LogSurvey> logs);

}  // namespace cablefit
