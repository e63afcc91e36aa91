// The model of one fit in a result file. Internal to results/.
#pragma once

#include <string>

#include "cablefit/base/json/json_document.hpp"
#include "cablefit/model/file/parts.hpp"

namespace cablefit::result_file {

/// Of cablefit/dynamic/1. `choice` says in words which was taken.
Model read_dynamic_model(const JsonNode& root, const model_file::Wanted& wanted,
                         std::string* choice);
/// Of cablefit/identify/1: the model that each of its preloads has whose dynamics were identified.
Model read_identify_model(const JsonNode& root, const model_file::Wanted& wanted,
                          std::string* choice);

/// The item whose `key` is `wanted`; when nothing is wanted the preferred or else the first one.
/// Throws Error(input) with what there is.
const JsonNode& pick(const JsonNode& list, std::string_view key, std::string_view wanted,
                     std::string_view preferred);
/// "preload 'low' (of low, high)": what was taken, and the others when nobody had asked.
std::string describe(const JsonNode& list, const JsonNode& taken, std::string_view what,
                     std::string_view key, std::string_view wanted);

}  // namespace cablefit::result_file
