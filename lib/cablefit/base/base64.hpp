// Bytes as text (RFC 4648, with padding), for numbers within JSON and HTML.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace cablefit {

std::string base64(std::string_view bytes);
/// Nothing when the text is no base64.
std::optional<std::string> from_base64(std::string_view text);

}  // namespace cablefit
