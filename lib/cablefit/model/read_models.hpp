// The models of all preloads in a file.
#pragma once

#include "cablefit/model/model.hpp"

namespace cablefit {

/// What a reader asks of a model: that it can be simulated, or no more than that it is well formed.
enum class Completeness { can_move, as_it_is };

/// As parse_model() of model.hpp.
Model parse_model(const JsonNode& root, const std::string& preload, const std::string& model,
                  std::string& choice, Completeness completeness);

/// As read_model() of model.hpp, but of a result (cablefit/dynamic/1, cablefit/identify/1) all its
/// preloads when none is wanted. With `Completeness::as_it_is` values that a fit could not
/// determine are NaN, those of inertias too.
std::vector<Model> read_models(const std::string& path, const std::string& preload,
                               const std::string& model, std::string& choice,
                               Completeness completeness = Completeness::can_move);

}  // namespace cablefit
