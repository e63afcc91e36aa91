// What each joint's controller has to move, and controllers made for it.
#pragma once

#include <functional>
#include <vector>

#include "cablefit/model/model.hpp"

namespace cablefit {

/// Of each link, the others held: of a coupled arm at q = 0. 0 where the model has none.
std::vector<double> link_inertias(const Model& model);

/// kg m^2, on a linear axis kg. Of the motor, and of motor and link together.
struct JointInertias {
  double motor = 0, all = 0;
};

/// Per joint. A link that is blocked, or whose fitted inertia is negative, adds none.
std::vector<JointInertias> joint_inertias(const Model& model, bool link_blocked = false);

/// A PD controller with a bandwidth, Hz, and a damping ratio for all that the joint moves. Its
/// derivative gain stays below what is stable for the motor alone at this period, s.
Controller pd_controller(const JointInertias& inertias, double bandwidth, double damping,
                         double period);

/// A controller of each joint, as `law` makes it from what that joint has to move. All have the
/// same period and reference.
Controller controller_by_inertias(const Model& model, bool link_blocked,
                                  const std::function<Controller(const JointInertias&)>& law);

}  // namespace cablefit
