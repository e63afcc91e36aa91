// What the lines behind a CSV header show before they are read: is it the header at all, and how
// are numbers written.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "cablefit/base/error.hpp"
#include "cablefit/log/csv_dialect.hpp"

namespace cablefit {

/// The first lines of a text that are no comments, with their numbers.
struct NumberedLine {
  std::string_view text;
  std::uint64_t number = 0;
};
/// `first`: number of the line that `text` begins with. A line that `text` cuts off is left out
/// unless it is the only one.
std::vector<NumberedLine> content_lines(std::string_view text, std::uint64_t first);

/// What keeps `header` from being the header of the lines behind it, with the option that mends it:
/// a preamble before the true header, or a row of units. Empty: nothing.
std::optional<Error> header_complaint(const NumberedLine& header,
                                      const std::vector<NumberedLine>& lines,
                                      const std::string& path);

/// Whether a comma is the decimal point: the delimiter leaves it free, and some number needs it.
bool has_decimal_commas(const std::vector<NumberedLine>& lines, Delimiter delimiter);

/// "1,5" or "-0,25e3"
bool is_decimal_comma_number(std::string text);

/// An empty cell or a word for one: nan, na, null, none, -
bool is_missing_cell(std::string_view text);

}  // namespace cablefit
