// The models of all preloads in a file.
#pragma once

#include "cablefit/model/model.hpp"

namespace cablefit {

/// As read_model() of model.hpp, but of a result (cablefit/dynamic/1, cablefit/identify/1) all its
/// preloads when none is wanted.
std::vector<Model> read_models(const std::string& path, const std::string& preload,
                               const std::string& model, std::string& choice);

}  // namespace cablefit
