// The rows of the table of cable laws, one per file. Internal to cables.cpp; everybody else goes
// through cable_laws().
#pragma once

#include "cablefit/model/cables.hpp"

namespace cablefit::laws {

/// f = K_0 l.
CableLaw linear();
/// f = K_0 l + K_1 l^2 + ... up to the order.
CableLaw polynomial();
/// Soft toe, then linear.
CableLaw strand();
/// Any shape with a continuous slope: lines of stiffness between knots.
CableLaw spline();

}  // namespace cablefit::laws
