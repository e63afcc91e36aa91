// What no rigid body can have. Internal to model/arm.
#pragma once

#include <string>

#include "cablefit/model/arm/serial_chain.hpp"

namespace cablefit {

/// What is wrong with a mass and an inertia about the centre of mass, how large, and what to do.
struct BodyFault {
  std::string what, remedy;  ///< both empty: nothing
};

/// `body`: about its centre of mass. A negative mass, an inertia without a mass, a negative
/// principal moment, or one that is larger than the sum of the others (triangle inequality;
/// Goldstein, Poole & Safko 2002, 5.4), by more than printed digits explain.
BodyFault body_fault(const LinkInertia& body);

}  // namespace cablefit
