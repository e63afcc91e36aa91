// The result file of `cablefit compare` (cablefit/compare/1).
#pragma once

#include <string>

#include "cablefit/campaign/compare/compare.hpp"

namespace cablefit {

/// `inputs`: the two result files. `failed_gates`: one line each.
std::string compare_json(const CompareResult& result, const std::vector<InputFile>& inputs,
                         const std::vector<std::string>& failed_gates);

}  // namespace cablefit
