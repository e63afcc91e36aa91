// The models that a refinement starts from, one per preload.
#pragma once

#include <span>
#include <vector>

#include "cablefit/model/model.hpp"
#include "cablefit/samples/survey/survey.hpp"

namespace cablefit {

/// Throws Error(usage) for two models of one preload, for models that are no two sets of values of
/// the same equations (their coefficients are shared), and for an event among what an earlier
/// refine added to one; other effects of that are part of it.
void require_model_set(std::span<const Model> models);

/// Those whose preload is in the logs; all of them when none is, so that the mismatch is reported.
std::vector<Model> models_with_logs(std::vector<Model> models, std::span<const LogSurvey> logs);

}  // namespace cablefit
