// The files that a stage's result is written to.
#pragma once

#include <vector>

#include "cablefit/identify/identify.hpp"
#include "cablefit/refine/refine_result.hpp"
#include "commands/delivery.hpp"

namespace cablefit::apps {

/// identify.json, and a model file per preload whose dynamics were identified.
std::vector<ResultFile> files_of(const IdentifyResult& result);
/// "refined.json", or "refined_PRELOAD.json" of each of several preloads.
std::vector<std::string> model_file_names(const RefineResult& result);
/// refine.json, and those models.
std::vector<ResultFile> files_of(const RefineResult& result);

}  // namespace cablefit::apps
