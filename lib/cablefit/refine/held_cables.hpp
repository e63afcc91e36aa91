// Cables whose coefficients a joint does not fit, because another joint's motor winds them and its
// own logs do not separate them (JointModel::holds_passing_cables). Internal to refine/.
#pragma once

#include <string>
#include <vector>

#include "cablefit/model/model.hpp"
#include "cablefit/refine/refine_options.hpp"
#include "cablefit/refine/refine_result.hpp"

namespace cablefit {

/// Joints of the models hold cables where the base fit does not determine all values. `models`: of
/// all joints, one per preload.
void hold_undetermined_cables(std::vector<Model>& models, const RefineLogs& logs);

/// Models of one joint hold cables from now on. False: they did already, or there are none to hold.
bool hold_cables(std::vector<Model>& one);

/// `joint`: from 0, among those of the model.
bool holds_cables(const Model& model, int joint);

/// The joints (from 0) in the order in which they are refined: those that hold cables last, with
/// what the others have found.
std::vector<int> refining_order(const Model& model);

/// Models of all joints take the cables that the motor of a refined joint winds. `one`: the models
/// of that joint.
void take_refined_cables(const std::vector<Model>& one, std::vector<Model>& models);

/// Adds the warning to the result of a joint that holds cables which its logs load.
void warn_of_held_cables(RefineResult& result);

}  // namespace cablefit
