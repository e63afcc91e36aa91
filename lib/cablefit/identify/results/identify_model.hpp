// The model of one preload that `simulate` runs.
#pragma once

#include <string>

#include "cablefit/identify/equations/preload_jobs.hpp"
#include "cablefit/identify/identify_result.hpp"

namespace cablefit {

/// None where a parameter is missing or stands where no drive can move; `why_not` says why, and is
/// empty where the dynamics were not looked for.
std::optional<Model> model_of(const IdentifyResult& result, const IdentifyPreload& preload,
                              const PreloadFacts& facts, std::string& why_not);

}  // namespace cablefit
