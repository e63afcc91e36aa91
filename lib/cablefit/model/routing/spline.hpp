// Cubic spline through points: twice continuously differentiable between the first and the last,
// with not-a-knot ends (the first two and last two pieces are one cubic each), so that cubics, and
// parabolas through three points, come out exactly. Source: de Boor 1978, A Practical Guide to
// Splines, ch. IV.
#pragma once

#include <vector>

namespace cablefit::maps {

struct SplineValue {
  double value, slope, curvature;
};

/// Second derivative at each of the points; x ascends, at least two points. O(n).
std::vector<double> spline_curvature(const std::vector<double>& x, const std::vector<double>& y);

/// Value and derivatives at `at`; outside the points the end tangent goes on (curvature 0).
SplineValue spline_at(const std::vector<double>& x, const std::vector<double>& y,
                      const std::vector<double>& curvature, double at);

}  // namespace cablefit::maps
