#include "cablefit/base/quote.hpp"

#include <fmt/format.h>

#include <cstddef>

namespace cablefit {
namespace {

constexpr std::size_t kMaxBytes = 60;

bool is_continuation(char c) { return (static_cast<unsigned char>(c) & 0xC0u) == 0x80u; }

// Length of the sequence that a UTF-8 lead byte announces, 0 when it is none.
std::size_t announced_length(unsigned char lead) {
  if (lead >= 0xC2 && lead <= 0xDF) return 2;
  if (lead >= 0xE0 && lead <= 0xEF) return 3;
  if (lead >= 0xF0 && lead <= 0xF4) return 4;
  return 0;
}

// Length of the printable character at the start of `text`, 0 when that byte has to be escaped.
std::size_t printable_length(std::string_view text) {
  const auto lead = static_cast<unsigned char>(text[0]);
  if (lead < 0x80) return lead >= 0x20 && lead != 0x7F ? 1 : 0;
  const std::size_t length = announced_length(lead);
  if (length == 0 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if (!is_continuation(text[i])) return 0;
  }
  // U+0080..U+009F are control characters, and terminals obey them.
  const bool is_control = lead == 0xC2 && static_cast<unsigned char>(text[1]) < 0xA0;
  return is_control ? 0 : length;
}

}  // namespace

std::string quoted(std::string_view text) {
  std::string shown = "'";
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t length = printable_length(text.substr(at));
    if (at + (length == 0 ? 1 : length) > kMaxBytes) return shown + "...'";
    if (length == 0) {
      shown += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[at++]));
    } else {
      shown += text.substr(at, length);
      at += length;
    }
  }
  return shown + "'";
}

}  // namespace cablefit
