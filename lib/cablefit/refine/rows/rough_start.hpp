// The first moments of a recording, where they are far rougher than the rest. Internal to refine/.
#pragma once

#include <Eigen/Core>

#include "cablefit/model/effects.hpp"

namespace cablefit {

/// Number of samples at the start that rows must leave out, of 60 ms and the kernels' reach at
/// most; 0: none. A robot that is let go away from its equilibrium, or whose drive is switched on,
/// moves faster there than anywhere later. The kernels do not resolve that, and simulated data sets
/// start from an estimated state, so that they do not repeat it.
Eigen::Index rough_start(const Recording& recording);

}  // namespace cablefit
