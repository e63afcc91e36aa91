// Texts that come from logs (names of preloads, paths), made harmless for each format.
#pragma once

#include <string>
#include <string_view>

#include "cablefit/base/quote.hpp"  // printable()

namespace cablefit {

/// Number of characters (code points) of a printable text.
std::size_t n_characters(std::string_view text);

/// A CSV cell: quoted where RFC 4180 requires it. A text that a spreadsheet would run as a formula
/// (it begins with = + - @ and is no number) gets a ' in front.
std::string csv_cell(std::string_view text);

/// A text within Markdown: printable, and without meaning to Markdown or HTML.
std::string markdown_text(std::string_view text);

}  // namespace cablefit
