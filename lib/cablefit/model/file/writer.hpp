// Parts of a model file as JSON values. Internal to model/file.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "cablefit/base/parameter_covariance.hpp"
#include "cablefit/model/effects.hpp"
#include "cablefit/model/rig.hpp"

namespace cablefit::model_file {

/// The object of a rig file; keys at their defaults are left out.
nlohmann::ordered_json rig_json(const Rig& rig);

/// An effect beyond the paper's: {"name", "side", "parameters": {...}, "event": {...}}.
nlohmann::ordered_json refinement_json(const EffectInstance& instance);

/// {"parameters": [...], "matrix": [[...]]}
nlohmann::ordered_json covariance_json(const ParameterCovariance& covariance);

}  // namespace cablefit::model_file
