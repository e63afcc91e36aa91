// What the error of l_o that were searched does to the values: l_o stands still in every fit of
// refine, so that these alone do not show it. Internal to refine/.
#pragma once

#include <vector>

#include "cablefit/model/elongation_covariance.hpp"
#include "cablefit/refine/rows/shape_moves.hpp"

namespace cablefit {

/// How the values of a design fitted with 1/level^2 change with l_o one sd away, along each axis of
/// the covariance; independent of each other.
std::vector<ValueChange> elongation_errors(const Design& design, const Eigen::VectorXd& x,
                                           const KindLevels& levels, double block_seconds,
                                           const ElongationCovariance& known);

}  // namespace cablefit
