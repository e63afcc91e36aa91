// A study as a document: the answers of all stages, then their tables and plots.
#pragma once

#include <string>
#include <vector>

#include "cablefit/report/parts/document.hpp"
#include "cablefit/session/study.hpp"

namespace cablefit {

/// `model_files`: name of the model of each entry of Study::refine.
Document study_document(const Study& study, const std::vector<std::string>& model_files);

}  // namespace cablefit
