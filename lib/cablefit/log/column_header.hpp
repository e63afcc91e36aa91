// Column names as CSV header cells and JSON keys have them.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "cablefit/log/log_reader.hpp"

namespace cablefit {

/// More are no log of a rig.
inline constexpr std::size_t kMostColumns = 10'000;

/// "theta [deg]" or "theta(deg)" -> name "theta", unit "deg". An index ("q[1]") belongs to the
/// name.
ColumnHeader to_column_header(std::string_view text, const Place& place);

/// Throws Error(input) for a text of a JSON log that is too long for the name or unit of a column,
/// of which there may be many.
void check_name_length(std::string_view text, const Place& place);

/// Throws Error(input) when two columns have one name, or when no column has any. Several columns
/// may lack a name (pandas writes its row numbers so): no one can select them.
void check_names(const std::vector<ColumnHeader>& columns, const Place& header_place);

}  // namespace cablefit
