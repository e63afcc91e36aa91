// Stage 1 as what `refine` starts from.
#pragma once

#include <string>
#include <vector>

#include "cablefit/model/model.hpp"

namespace cablefit {

/// Whether the file is a cablefit/elastic/1. Throws Error(input) when it is no JSON.
bool is_elastic_result(const std::string& path);

/// One model per preload (or only `preload`), of the fit `model` (empty: "poly", else the first):
/// its cables, offset and friction band. They know nothing of the link nor of inertias. `choice`
/// says in words which was taken.
std::vector<Model> read_elastic_models(const std::string& path, const std::string& preload,
                                       const std::string& model, std::string& choice);

}  // namespace cablefit
