// Lines in the spectrum of the residual over the position: periods that repeat many times within
// the range of the motion, such as a motor's poles or the turns of a screw behind a reduction.
// Internal to refine/.
#pragma once

#include "cablefit/refine/rows/levels.hpp"

namespace cablefit {

/// Up to `n` orders (periods times 2 pi per rad, on a linear axis per m), the strongest first,
/// between `lowest` and the highest order that rows can show. At the highest order and the usual
/// speed, the phase moves by half a period between two evaluations of a column. Only of the motor's
/// equation; none without rows. `x`: values of the design's columns.
std::vector<double> strongest_orders(const Design& design, const Eigen::VectorXd& x, double lowest,
                                     int n);

}  // namespace cablefit
