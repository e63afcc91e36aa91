// How sure the numbers of a design are, as the parameters of its model are. Internal to design/.
#pragma once

#include <vector>

#include "cablefit/design/design_sweep.hpp"
#include "cablefit/model/principal_copies.hpp"

namespace cablefit {

/// The sd of what `joint` says of these cables: each copy of the model, preloaded in the same way,
/// is described too (principal_copies.hpp). Numbers that a copy does not have, as where it never
/// gives the torque, stay NaN.
DesignSpread spread_of(const DesignJoint& joint, const DesignPoint& point,
                       const std::vector<MovedModel>& copies, int number,
                       const DesignOptions& options);

}  // namespace cablefit
