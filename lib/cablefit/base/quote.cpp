#include "cablefit/base/quote.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

namespace cablefit {
namespace {

constexpr std::size_t kMaxBytes = 60;

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

/// A character and its length in bytes; of valid UTF-8.
struct Character {
  char32_t code = 0;
  std::size_t length = 1;
};

Character first_character(std::string_view text) {
  const auto byte = [text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const std::size_t length = announced_length(byte(0));
  if (length == 0 || length > text.size()) return {byte(0), 1};
  char32_t code = byte(0) & (0x7Fu >> length);
  for (std::size_t i = 1; i < length; ++i) code = code << 6u | (byte(i) & 0x3Fu);
  return {code, length};
}

/// Marks without a shape that turn the direction of the text after them (Unicode, annex 9).
bool is_direction_mark(char32_t code) {
  return code == 0x061C || code == 0x200E || code == 0x200F || (code >= 0x202A && code <= 0x202E) ||
         (code >= 0x2066 && code <= 0x2069);
}

/// Hebrew, Arabic and the other scripts that are written from right to left.
bool is_right_to_left(char32_t code) {
  return (code >= 0x0590 && code <= 0x08FF) || (code >= 0xFB1D && code <= 0xFDFF) ||
         (code >= 0xFE70 && code <= 0xFEFF) || (code >= 0x10800 && code <= 0x10FFF) ||
         (code >= 0x1E800 && code <= 0x1EFFF);
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
  const bool is_sound = is_sound_second(lead, static_cast<unsigned char>(text[1]));
  return is_sound && !is_direction_mark(first_character(text).code) ? length : 0;
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

std::string in_quotes(std::string_view text) { return fmt::format("'{}'", shortened(text)); }

std::string isolated(std::string_view text) {
  constexpr std::string_view kBegin = "\u2068", kEnd = "\u2069";
  std::string result;
  bool is_inside = false;
  while (!text.empty()) {
    const Character next = first_character(text);
    if (is_right_to_left(next.code) != is_inside) {
      result += is_inside ? kEnd : kBegin;
      is_inside = !is_inside;
    }
    result += text.substr(0, next.length);
    text.remove_prefix(next.length);
  }
  return is_inside ? result.append(kEnd) : result;
}

}  // namespace cablefit
