// Models out of files: model files, and results that have the model of a fit.
#pragma once

#include <string>
#include <vector>

#include "cablefit/model/completeness.hpp"
#include "cablefit/model/model.hpp"

namespace cablefit {

class JsonNode;

/// A model file, or a result file (cablefit/dynamic/1, cablefit/identify/1) plus the preload and
/// model wanted; empty: the only one, else the first preload and "poly". `choice` says in words
/// which was taken. Throws Error(input) with file:line:column.
Model read_model(const std::string& path, const std::string& preload, const std::string& model,
                 std::string& choice);
/// The same from a document that is read already.
Model parse_model(const JsonNode& root, const std::string& preload, const std::string& model,
                  std::string& choice, Completeness completeness = Completeness::can_move);

/// As read_model(), but of a result all its preloads when none is wanted.
std::vector<Model> read_models(const std::string& path, const std::string& preload,
                               const std::string& model, std::string& choice,
                               Completeness completeness = Completeness::can_move);

}  // namespace cablefit
