// What `cablefit refine` found, for people: a story of about ten lines, then the tables behind it.
#pragma once

#include "cablefit/refine/refine_result.hpp"
#include "cablefit/report/parts/document.hpp"

namespace cablefit {

/// `model_files`: where the refined models go, one per result.models.
Document refine_document(const RefineResult& result, const std::vector<std::string>& model_files);

}  // namespace cablefit
