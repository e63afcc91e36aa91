// Where a function on a grid is zero and where it is positive, for drawing: values(i, j) at (x(i),
// y(j)), x and y ascending, linear along the edges of a cell (marching squares; Lorensen & Cline
// 1987 in the plane).
#pragma once

#include <Eigen/Core>

#include "cablefit/figure/figure.hpp"

namespace cablefit {

/// Fills x and y with the lines on which the values are zero, positive ones to their left; NaN
/// between lines. A line that closes ends where it began. Nothing where no sign changes.
void draw_zero_lines(const Eigen::VectorXd& x, const Eigen::VectorXd& y,
                     const Eigen::MatrixXd& values, Trace& trace);

/// Fills x and y with closed outlines of where the values are positive, for TraceStyle::area:
/// counter-clockwise, those of holes clockwise.
void draw_positive_area(const Eigen::VectorXd& x, const Eigen::VectorXd& y,
                        const Eigen::MatrixXd& values, Trace& trace);

}  // namespace cablefit
