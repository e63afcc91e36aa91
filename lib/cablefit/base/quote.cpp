#include "cablefit/base/quote.hpp"

#include <fmt/format.h>

#include <algorithm>
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

// Whether the second byte makes this the shortest form of a character that exists: "\xe0\x80\x9b"
// is an escape character to a careless decoder.
bool is_sound_second(unsigned char lead, unsigned char second) {
  if (lead == 0xE0) return second >= 0xA0;
  if (lead == 0xED) return second < 0xA0;  // half of a UTF-16 pair
  if (lead == 0xF0) return second >= 0x90;
  if (lead == 0xF4) return second < 0x90;
  // U+0080..U+009F are control characters, and terminals obey them.
  return lead != 0xC2 || second >= 0xA0;
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
  return is_sound_second(lead, static_cast<unsigned char>(text[1])) ? length : 0;
}

bool is_plain(char c) { return c >= 0x20 && c < 0x7F; }

// Takes the first character off `text` and appends it to `shown`.
void move_character(std::string_view& text, std::string& shown) {
  const std::size_t length = printable_length(text);
  if (length == 0) {
    shown += fmt::format("\\x{:02x}", static_cast<unsigned char>(text.front()));
  } else {
    shown += text.substr(0, length);
  }
  text.remove_prefix(length == 0 ? 1 : length);
}

}  // namespace

std::string printable(std::string_view text) {
  std::string shown;
  while (!text.empty()) {
    const auto special = std::find_if_not(text.begin(), text.end(), is_plain);
    const auto n_plain = static_cast<std::size_t>(special - text.begin());
    shown += text.substr(0, n_plain);
    text.remove_prefix(n_plain);
    if (!text.empty()) move_character(text, shown);
  }
  return shown;
}

std::string shortened(std::string_view text) {
  std::string shown;
  const std::size_t n_bytes = text.size();
  while (!text.empty()) {
    const std::size_t length = std::max<std::size_t>(1, printable_length(text));
    if (n_bytes - text.size() + length > kMaxBytes) return shown + "...";
    move_character(text, shown);
  }
  return shown;
}

std::string quoted(std::string_view text) { return fmt::format("'{}'", shortened(text)); }

}  // namespace cablefit
