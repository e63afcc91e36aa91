// Parts of a model file as JSON values. Internal to model/file.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "cablefit/model/rig.hpp"

namespace cablefit::model_file {

/// The object of a rig file; keys at their defaults are left out.
nlohmann::ordered_json rig_json(const Rig& rig);

}  // namespace cablefit::model_file
