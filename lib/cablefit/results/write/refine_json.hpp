// What `cablefit refine` found as JSON (cablefit/refine/1, data/schema/refine.schema.json).
#pragma once

#include <span>
#include <string>

#include "cablefit/refine/refine_result.hpp"

namespace cablefit {

/// `model_files`: names of the refined models' files, one per result.models, as they stand beside
/// the result.
std::string refine_json(const RefineResult& result, std::span<const std::string> model_files);

}  // namespace cablefit
