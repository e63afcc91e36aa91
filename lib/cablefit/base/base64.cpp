#include "cablefit/base/base64.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace cablefit {
namespace {

constexpr std::string_view kDigits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

}  // namespace

std::string base64(std::string_view bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    const std::size_t n = std::min<std::size_t>(3, bytes.size() - i);
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8u | (k < n ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += k <= n ? kDigits[word >> (18u - 6u * static_cast<unsigned>(k)) & 63u] : '=';
  }
  return text;
}

std::optional<std::string> from_base64(std::string_view text) {
  if (text.size() % 4 != 0) return std::nullopt;
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3);
  for (std::size_t i = 0; i < text.size(); i += 4) {
    std::string_view four = text.substr(i, 4);
    if (i + 4 == text.size())  // only the last may be padded
      while (four.size() > 2 && four.back() == '=') four.remove_suffix(1);
    std::uint32_t word = 0;
    for (const char c : four) {
      const std::size_t digit = kDigits.find(c);
      if (digit == std::string_view::npos) return std::nullopt;
      word = word << 6u | static_cast<std::uint32_t>(digit);
    }
    word <<= 6 * (4 - four.size());
    for (std::size_t k = 0; k + 1 < four.size(); ++k)
      bytes += static_cast<char>(static_cast<unsigned char>(word >> (16 - 8 * k) & 255u));
  }
  return bytes;
}

}  // namespace cablefit
