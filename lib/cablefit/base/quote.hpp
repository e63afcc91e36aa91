// Texts taken from files, made safe to print.
#pragma once

#include <string>
#include <string_view>

namespace cablefit {

/// Control bytes and bytes that are not UTF-8 become \xNN: a file cannot steer the terminal.
std::string printable(std::string_view text);

/// The same, and what does not fit in 60 bytes is replaced by "...".
std::string shortened(std::string_view text);

/// shortened() in single quotes.
std::string quoted(std::string_view text);

}  // namespace cablefit
