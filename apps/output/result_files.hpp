// The files that a stage's result is written to.
#pragma once

#include <vector>

#include "cablefit/identify/identify.hpp"
#include "cablefit/refine/refine_result.hpp"
#include "output/delivery.hpp"

namespace cablefit::apps {

/// identify.json, and a model file per preload whose dynamics were identified.
std::vector<ResultFile> files_of(const IdentifyResult& result);
/// "STEM.json", or "STEM_PRELOAD.json" of each of several preloads.
std::vector<std::string> names_by_preload(const std::string& stem,
                                          const std::vector<std::string>& preloads);
/// "refined.json", or "refined_PRELOAD.json" of each of several models.
std::vector<std::string> model_file_names(const RefineResult& result);
/// Where files of these names are, as a reader types them.
std::vector<std::string> paths_below(const std::string& folder,
                                     const std::vector<std::string>& names);
/// The result as `name`, and its models.
std::vector<ResultFile> files_of(const RefineResult& result, const std::string& name,
                                 const std::vector<std::string>& model_names);

}  // namespace cablefit::apps
