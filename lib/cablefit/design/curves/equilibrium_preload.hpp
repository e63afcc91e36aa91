// Cables stretched so that they hold each other without any torque, Fichera & Grossard 2017, (8c):
// P f_o = S f_o = 0.
#pragma once

#include "cablefit/model/cables.hpp"

namespace cablefit {

/// Tensions that are in equilibrium in the reference pose, the largest 1; n_cables, all above 0.
/// Those nearest to the tensions that the cables have now, where these hold each other, else to
/// equal ones. Throws Error(input) when no tensions above 0 are in equilibrium.
Eigen::VectorXd balanced_tensions(const Transmission& transmission);

/// The transmission preloaded until its first cable has this initial elongation (>= 0, m; rad in
/// joint space), the others balanced against it; at 0 no cable is stretched. Exact to the last bits
/// of each l_o. Throws as above, and where a cable cannot reach its tension.
Transmission with_preload(const Transmission& transmission, double l_o);

/// The transmission with the nearest preload in equilibrium: tensions f >= 0 with P f = S f = 0 of
/// least |f - f_o|, f_o its own. A slack cable that gets no tension keeps its l_o. Throws where a
/// cable cannot reach its tension.
Transmission with_nearest_balance(const Transmission& transmission);

/// Every pulley's radius times `factor`, the cables and their l_o as they are.
Transmission with_radii(const Transmission& transmission, double factor);

}  // namespace cablefit
