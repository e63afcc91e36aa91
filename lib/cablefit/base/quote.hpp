// Texts taken from files, made safe to print inside an error message.
#pragma once

#include <string>
#include <string_view>

namespace cablefit {

/// `text` in single quotes: control bytes and bytes that are not UTF-8 become \xNN, and what does
/// not fit in 60 bytes is replaced by "...".
std::string quoted(std::string_view text);

}  // namespace cablefit
