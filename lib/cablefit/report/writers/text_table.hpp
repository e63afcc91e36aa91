// A table with columns lined up, as a terminal shows it.
#pragma once

#include <string>

#include "cablefit/report/documents/document.hpp"

namespace cablefit {

/// Title, header of up to three lines (group, title, unit), rule, rows and notes.
std::string text_table(const Table& table);

/// Characters of its longest row.
std::size_t text_table_width(const Table& table);

/// Tables wider than this are laid out otherwise by those who make documents.
inline constexpr std::size_t kTextWidth = 110;

}  // namespace cablefit
