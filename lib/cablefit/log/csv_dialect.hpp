// How one CSV file separates its cells, read off its header line.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "cablefit/log/log_reader.hpp"

namespace cablefit {

/// Cells end at a comma, semicolon or tab, or (written ' ') at any run of blanks.
enum class Delimiter : char { comma = ',', semicolon = ';', tab = '\t', blanks = ' ' };

/// A cell and where its text stands in the line. Quotes around it are taken off.
struct Cell {
  std::string text;
  std::size_t offset = 0;
};

/// Comma, semicolon or tab, whichever stands outside brackets and quotes most often, else blanks.
Delimiter find_delimiter(std::string_view header_line);

/// The cells of a header line: brackets hold their content together, and between blanks a bracket
/// belongs to the name before it, as in "t theta [deg]". `n_max`: no more cells than that.
std::vector<Cell> split_header(std::string_view line, Delimiter delimiter, std::size_t n_max);

/// The cells of a row, for messages only; the reader parses rows in place.
std::vector<Cell> split_row(std::string_view line, Delimiter delimiter);

/// The text between quotes, in which a doubled quote stands for itself.
std::string without_doubled_quotes(std::string_view text);

/// A comment or nothing but blanks.
bool is_skipped_line(std::string_view line, Delimiter delimiter);

}  // namespace cablefit
