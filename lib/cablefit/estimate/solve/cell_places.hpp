// Where the cells of a RowStatistics lie in time.
#pragma once

#include <vector>

#include "cablefit/estimate/solve/row_statistics.hpp"

namespace cablefit {

/// Place of every cell in a series of stretches of time, from 0: a gap between cells is one in the
/// series, at most kLongestGap long. Cells that count anew (another log's first windows) follow
/// right behind.
std::vector<Eigen::Index> cell_places(const std::vector<GramCell>& cells);
inline constexpr Eigen::Index kLongestGap = 256;  // nothing is correlated over more

}  // namespace cablefit
