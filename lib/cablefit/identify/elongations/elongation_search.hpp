// The initial elongations from many starts, since every cable that goes slack makes a kink.
#pragma once

#include <vector>

#include "cablefit/identify/elongations/elongation_descent.hpp"

namespace cablefit {

/// Sets fit.weights by the best own residuals of the equations, and returns the best point that
/// `descend` reaches from the best points of a grid over the preloads and the groups of cables that
/// are searched. Nothing searched: the one point there is. Where several explanations fit alike,
/// the one that determines least. `grid_scale`: stretches the grid.
JointPoint search_elongations(JointFit& fit, double grid_scale = 1);

/// Of the points, and of all searched cables taut wherever the logs went (group by group), the
/// explanation that stands beside the best and claims least: linear cables that never go slack look
/// like one cable at a time, twice as stiff, without preload.
JointPoint least_certain(JointFit& fit, std::vector<JointPoint> points);

}  // namespace cablefit
