// cablefit/identify/1 as a model. Internal to model/.
#pragma once

#include "cablefit/model/file/parts.hpp"

namespace cablefit::model_file {

inline constexpr std::string_view kIdentifySchema = "cablefit/identify/1";

/// The model that each of its preloads carries whose dynamics were identified.
Model read_identify_file(const JsonNode& root, const Wanted& wanted, std::string* choice);

}  // namespace cablefit::model_file
