// Rows of a log that say nothing, and why.
#pragma once

#include <string>

#include "cablefit/samples/rows/equation_rows.hpp"

namespace cablefit {

/// "12 % of the rows are not used: ..." where more than kUnusedNoted of them are lost to anything
/// but standstill: edges of segments, segments too short to filter. Empty: fewer are.
std::string unused_rows_warning(const WindowCounts& windows, const RowCounts& rows);
inline constexpr double kUnusedNoted = 0.05;

}  // namespace cablefit
