// Names of the regions of a map.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "cablefit/figure/figure.hpp"

namespace cablefit {

/// A note for every connected region of a grid, at its node farthest from other regions and from
/// the edge, of these the nearest to the middle. `kinds`: which of `names` a node has, x.size() x
/// y.size(). Regions less than `least_depth` nodes deep have no room for a word and get none.
std::vector<Note> region_notes(const Eigen::VectorXd& x, const Eigen::VectorXd& y,
                               const Eigen::ArrayXXi& kinds, const std::vector<std::string>& names,
                               int least_depth);

}  // namespace cablefit
