// What a controller that does for every joint has to be made for.
#pragma once

#include "cablefit/model/model.hpp"

namespace cablefit {

/// Of each link, the others held: of a coupled arm at q = 0. 0 where the model has none.
std::vector<double> link_inertias(const Model& model);

/// The least of all joints, kg m^2 (on a linear axis kg): of the motor, and of all that it moves.
struct LeastInertias {
  double motor = kUnbounded, all = kUnbounded;
};
LeastInertias least_inertias(const Model& model, bool link_blocked = false);

}  // namespace cablefit
