// What even the best candidate leaves beyond the floor, as disturbance torques of the same colour:
// a search has to be judged against what it finds by chance in such a wandering. Internal to
// refine/.
#pragma once

#include "cablefit/prove/twin.hpp"
#include "cablefit/refine/evidence.hpp"

namespace cablefit {

/// Of the link and motor rows of a design under these values; none where the residual is at its
/// floor. One joint.
TwinDisturbance remainder_of(const Design& design, const Eigen::VectorXd& x,
                             const KindLevels& floor);

/// The same disturbance with sd times `factors`, per kind of row.
TwinDisturbance scaled(TwinDisturbance disturbance, const KindLevels& factors);

bool is_quiet(const TwinDisturbance& disturbance);

}  // namespace cablefit
