// Is an effect the same law everywhere? If it approximates another law, its size or sign differs
// between parts of the motion. Internal to refine/.
#pragma once

#include <string>

#include "cablefit/refine/rows/evidence.hpp"

namespace cablefit {

/// Halves the rows by position, direction, speed and so on (regime_variables.hpp), and fits the
/// size of effect `which` of design.added in both halves, in units of its size over all rows.
/// Returns the first variable for which the halves differ threefold and significantly (3 sd over
/// the blocks); empty: they agree. Events and effects without a column of their own always agree.
std::string why_not_one_law(const Design& design, const Eigen::VectorXd& x,
                            const KindLevels& levels, std::size_t which, double block_seconds);

}  // namespace cablefit
