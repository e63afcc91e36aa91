// Is an effect the same law everywhere? One that stands for something else has another size, or the
// other sign, in another part of the motion. Internal to refine/.
#pragma once

#include <string>

#include "cablefit/refine/rows/evidence.hpp"

namespace cablefit {

/// Halves the rows by position, direction, speed and so on (regime_variables.hpp) and fits the size
/// of effect `which` of design.added in both, in units of its size over all rows. Names the first
/// variable by which they differ threefold and by more than chance (3 sd over the blocks); empty:
/// they agree. Events and effects without a column of their own always do.
std::string why_not_one_law(const Design& design, const Eigen::VectorXd& x,
                            const KindLevels& levels, std::size_t which, double block_seconds);

}  // namespace cablefit
