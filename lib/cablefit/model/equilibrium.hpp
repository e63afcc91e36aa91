// Whether a preload is in equilibrium, Fichera & Grossard 2017, (8c): P f_o = S f_o = 0 in the
// reference pose. Torques in N m (N on a linear axis).
#pragma once

#include <string>
#include <vector>

#include "cablefit/base/axes.hpp"
#include "cablefit/model/cables.hpp"

namespace cablefit {

/// A joint (from 0) that the preload alone would move.
struct Imbalance {
  int joint = 0;
  double link = 0, motor = 0;  ///< P f_o and S f_o
  double share = 0;            ///< of the sum of its cables' torques, the larger of both sides
};

/// Below this share of the sum of the cables' torques, coefficients and l_o are no better known.
inline constexpr double kBalanced = 0.02;

/// Joints on which the preload makes more than kBalanced of the sum of its cables' torques.
std::vector<Imbalance> imbalances(const Transmission& transmission);
/// One sentence: what, how large, and what to do.
std::string imbalance_text(const Imbalance& imbalance, int n_joints, Axes axes);

}  // namespace cablefit
