// Where the gap is: the share of each equation's squared residual above its floor by speed,
// direction, position, deflection, load and time. Internal to refine/.
#pragma once

#include "cablefit/refine/evidence.hpp"
#include "cablefit/refine/refine_result.hpp"

namespace cablefit {

/// The cells that stand out most, largest share first; none where the residual is at its floor.
std::vector<Regime> find_regimes(const Design& design, const Eigen::VectorXd& x,
                                 const KindLevels& floor);

}  // namespace cablefit
