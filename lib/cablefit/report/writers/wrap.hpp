// Long texts in lines that a terminal shows whole.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace cablefit {

/// Lines of the terminal, and tables that are laid out otherwise when they are wider.
inline constexpr std::size_t kTextWidth = 100;

/// A printable text in lines of at most `width` characters (code points), at least one. Breaks at
/// blanks, but not between a number and "%" or "N m"; words that are longer behind their last '/',
/// else anywhere.
std::vector<std::string> wrapped_lines(std::string_view text, std::size_t width);

/// The same as one text that begins with `first`; further lines begin with as many blanks as
/// `margin`. Ends with a line feed.
std::string wrapped(std::string_view first, std::string_view text, std::size_t margin);

}  // namespace cablefit
