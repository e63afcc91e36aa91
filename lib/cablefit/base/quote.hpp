// Texts taken from files, made safe to print.
#pragma once

#include <string>
#include <string_view>

namespace cablefit {

/// Whether a byte of UTF-8 continues the character before it.
inline bool is_continuation(char c) { return (static_cast<unsigned char>(c) & 0xC0u) == 0x80u; }

/// Control bytes, bytes that are not UTF-8 and marks that turn the direction of text become \xNN: a
/// file cannot steer the terminal.
std::string printable(std::string_view text);

/// The same, and what does not fit in 60 bytes is replaced by "...".
std::string shortened(std::string_view text);

/// shortened() in single quotes.
std::string in_quotes(std::string_view text);

/// Valid UTF-8 with each run of right-to-left letters between U+2068 and U+2069 (first strong
/// isolate): the run cannot reorder the text beside it, in HTML and SVG as in their attributes.
std::string isolated(std::string_view text);

}  // namespace cablefit
