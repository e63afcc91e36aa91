// A table with columns lined up, as a terminal shows it.
#pragma once

#include <string>

#include "cablefit/report/parts/document.hpp"

namespace cablefit {

/// Title, header of up to three lines (group, title, unit), rule, rows and notes, at most
/// kTextWidth wide: texts are wrapped where they must be. A table with too many numbers is wider.
std::string text_table(const Table& table);

/// Characters of its longest row, nothing wrapped.
std::size_t text_table_width(const Table& table);

}  // namespace cablefit
