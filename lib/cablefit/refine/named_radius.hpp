// Results of refine with the right radius of a pulley, beside those with the radius of the rig
// file. Internal to refine/.
#pragma once

#include <vector>

#include "cablefit/refine/refine_result.hpp"
#include "cablefit/refine/wrong_radius.hpp"

namespace cablefit {

/// Whether the right radius explains the logs as well as the effects that were identified with the
/// given one. `given`, `right`: results of each joint with either.
bool is_explained(const std::vector<RefineResult>& given, const std::vector<RefineResult>& right);

/// Adds cable_radius to the results with the right radius. Gaps before are those with the given
/// one. `model`: of all joints.
void name_radius(const WrongRadius& wrong, const Model& model,
                 const std::vector<RefineResult>& given, std::vector<RefineResult>& right);

}  // namespace cablefit
