// A study as JSON: which stages have a result, where it is, and the answers in words.
#pragma once

#include <string>
#include <vector>

#include "cablefit/report/parts/document.hpp"
#include "cablefit/session/study.hpp"

namespace cablefit {

/// cablefit/study/1. `files`: names of the stages' result files, beside this one. The numbers are
/// in them.
std::string study_json(const Study& study, const Document& document,
                       const std::vector<std::string>& files);

}  // namespace cablefit
