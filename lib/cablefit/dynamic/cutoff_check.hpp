// Is an inertia that was found there at another cut-off too?
#pragma once

#include "cablefit/dynamic/estimators.hpp"

namespace cablefit {

/// Fits every equation again by least squares with half and twice the cut-off, and refuses the
/// inertias of `estimation` whose 95 % intervals there and here do not meet and that move by more
/// than kMovedInertia: filtered noise of speeds and torques has an "inertia" of its own, that of a
/// drive is the same in every band. Not for links that share parameters.
void refuse_moving_inertias(const EstimationTask& task, Estimation& estimation);
inline constexpr double kMovedInertia = 0.2;

}  // namespace cablefit
