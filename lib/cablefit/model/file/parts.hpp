// Readers and writers behind model.hpp. Internal to model/.
#pragma once

#include <string>
#include <string_view>

#include "cablefit/base/axes.hpp"
#include "cablefit/base/json/json_document.hpp"
#include "cablefit/model/completeness.hpp"
#include "cablefit/model/model.hpp"

namespace cablefit::model_file {

/// What the caller asked for; empty: nothing in particular.
struct Wanted {
  std::string preload, model;
  Completeness completeness = Completeness::can_move;
};

/// cablefit/model/1. `choice` says in words what was taken.
Model read_model_file(const JsonNode& root, const Wanted& wanted, std::string* choice);

/// A parameter of that name and unit (SI): a bare number, or an object with value, and perhaps unit
/// (converted; must be of the same kind), sd, sd_white, ci95, cad, not_identifiable, active_bound.
Estimate read_estimate(const JsonNode& node, std::string name, std::string_view symbol,
                       std::string_view unit);
/// The same for a file written by hand: any other key is an error.
Estimate read_strict_estimate(const JsonNode& node, std::string name, std::string_view symbol,
                              std::string_view unit);

/// "refinements" of a joint: [{"name", "side", "parameters": {...}, "event": {"log", "time"}}].
std::vector<EffectInstance> read_refinements(const JsonNode& node, Axes axes, bool rigid);
/// The same of all joints in one list, each entry with its "joint" (from 1; a rig of one joint may
/// leave it out), as results have them. Throws for a joint that the rig lacks.
EffectsPerJoint read_effects_per_joint(const JsonNode& node, const Rig& rig, bool rigid);

/// "covariance": {"parameters": [names], "matrix": [rows]}. Throws for another number of rows or
/// columns than names.
ParameterCovariance read_covariance(const JsonNode& node);

/// "transmission" of a model file, for the cables that the model's rig has.
void read_transmission(const JsonNode& node, Model* model);

/// A rig: an object in place, or the path of a rig file, relative to the file it stands in or, when
/// there is none, to the current folder. Null or missing: the default rig.
Rig read_rig_reference(const JsonNode* node);

/// "arm" of a model file: the base parameters of its rig's coupled arm, by name.
std::vector<Estimate> read_arm(const JsonNode& node, const Rig& rig);
/// Throws at `node` unless every axis carries a positive inertia: the links of a coupled arm by
/// base parameters that all have a value.
void require_inertia(const Model& model, const JsonNode& node);

}  // namespace cablefit::model_file
