// Lines of the residual over the position: what repeats many times in the range of the motion, as a
// motor's poles or the turns of a screw behind a reduction. Internal to refine/.
#pragma once

#include "cablefit/refine/rows/levels.hpp"

namespace cablefit {

/// Up to `n` orders (periods times 2 pi per rad, on a linear axis per m), the strongest first, from
/// `lowest` to the highest that rows can show: at the usual speed its phase moves by half a
/// period from one evaluation of a column to the next. Of the motor's equation; none without rows.
/// `x`: values of the design's columns.
std::vector<double> strongest_orders(const Design& design, const Eigen::VectorXd& x, double lowest,
                                     int n);

}  // namespace cablefit
