// Reads models from files: model files, and results that contain a fitted model.
#pragma once

#include <string>
#include <vector>

#include "cablefit/model/completeness.hpp"
#include "cablefit/model/model.hpp"

namespace cablefit {

class JsonNode;

/// Reads a model file, or a result file (cablefit/dynamic/1, cablefit/identify/1) with the wanted
/// preload and model. Empty: the only one, else the first preload and "poly". `choice` states in
/// words which was taken. Throws Error(input) with file:line:column.
Model read_model(const std::string& path, const std::string& preload, const std::string& model,
                 std::string& choice);
/// As above, from a parsed document.
Model parse_model(const JsonNode& root, const std::string& preload, const std::string& model,
                  std::string& choice, Completeness completeness = Completeness::can_move);

/// As read_model(), but for a result all its preloads when `preload` is empty.
std::vector<Model> read_models(const std::string& path, const std::string& preload,
                               const std::string& model, std::string& choice,
                               Completeness completeness = Completeness::can_move);

}  // namespace cablefit
