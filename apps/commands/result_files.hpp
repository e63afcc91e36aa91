// The files that a stage's result is written to.
#pragma once

#include <vector>

#include "cablefit/identify/identify.hpp"
#include "cablefit/refine/refine_result.hpp"
#include "commands/delivery.hpp"

namespace cablefit::apps {

/// identify.json, and a model file per preload whose dynamics were identified.
std::vector<ResultFile> files_of(const IdentifyResult& result);
/// "refined.json", or "refined_PRELOAD.json" of each of several preloads, or of one that stands
/// `beside_others`.
std::vector<std::string> model_file_names(const RefineResult& result, bool beside_others = false);
/// refine.json (refine_PRELOAD.json beside others), and those models.
std::vector<ResultFile> files_of(const RefineResult& result, bool beside_others = false);

}  // namespace cablefit::apps
