#include "cablefit/model/least_inertias.hpp"

#include <algorithm>

namespace cablefit {

LeastInertias least_inertias(const Model& model, bool link_blocked) {
  LeastInertias least;
  for (const JointModel& joint : model.joints) {
    const double motor = inertia_of(joint.motor);
    least.motor = std::min(least.motor, motor);
    least.all = std::min(least.all, motor + (link_blocked ? 0 : inertia_of(joint.link)));
  }
  return least;
}

}  // namespace cablefit
