// The cells of a CSV row, parsed where they stand. This is the hot loop of reading a log: nothing
// here allocates, and a function that meets anything wrong returns nullptr; finding out what is
// wrong is left to csv_complaint.hpp.
#pragma once

#include <fast_float/fast_float.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <system_error>

#include "cablefit/log/csv_dialect.hpp"

namespace cablefit {

/// Reads a number that is written as digits, point, digits with at most 15 digits in all, followed
/// by something else than 'e'; nullptr for any other. The text must go on behind it. Both the
/// digits as an integer and the power of ten are exact doubles then, so their quotient is the
/// nearest one to the decimal number (Clinger 1990).
/// `point`: the decimal point, or a comma.
inline const char* read_plain_number(const char* p, double& value, char point = '.') {
  constexpr double kPowers[] = {1e0, 1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};
  const auto digit = [](char c) { return static_cast<unsigned>(c) - '0'; };
  const bool is_negative = *p == '-';
  p += is_negative ? 1 : 0;
  const char* const begin = p;
  std::uint64_t digits = 0;
  for (; digit(*p) < 10; ++p) digits = 10 * digits + digit(*p);
  std::ptrdiff_t n_digits = p - begin, n_decimals = 0;
  if (*p == point) {
    const char* const decimals = ++p;
    for (; digit(*p) < 10; ++p) digits = 10 * digits + digit(*p);
    n_decimals = p - decimals;
  }
  n_digits += n_decimals;
  if (n_digits == 0 || n_digits > 15 || n_decimals == n_digits || (*p | 0x20) == 'e')
    return nullptr;
  const double magnitude = static_cast<double>(digits) / kPowers[n_decimals];
  value = is_negative ? -magnitude : magnitude;
  return p;
}

/// Reads a finite number with an optional sign at the very start of [p, end); returns its end.
inline const char* read_number(const char* p, const char* end, double& value, char point = '.') {
  if (end - p > 1 && *p == '+' && p[1] != '-' && p[1] != '+') ++p;
  const fast_float::parse_options options{fast_float::chars_format::general, point};
  const auto [rest, status] = fast_float::from_chars_advanced(p, end, value, options);
  // Out of range is judged by the value: an infinity is refused, a tiny number is zero.
  const bool is_read = status == std::errc() || status == std::errc::result_out_of_range;
  return is_read && std::isfinite(value) ? rest : nullptr;
}

/// How a line is split into cells. Every function takes and returns places within one line.
template <Delimiter kDelimiter>
struct RowSyntax {
  static constexpr bool kBlanksDelimit = kDelimiter == Delimiter::blanks;

  static bool is_blank(char c) { return c == ' ' || (c == '\t' && kDelimiter != Delimiter::tab); }
  static bool is_delimiter(char c) {
    return kBlanksDelimit ? is_blank(c) : c == static_cast<char>(kDelimiter);
  }
  static const char* skip_blanks(const char* p, const char* end) {
    while (p != end && is_blank(*p)) ++p;
    return p;
  }

  /// The line feed at or after `p`; there must be one.
  static const char* find_line_end(const char* p, const char* end) {
    return static_cast<const char*>(std::memchr(p, '\n', static_cast<std::size_t>(end - p)));
  }

  /// First delimiter at or after `p`, or the end.
  static const char* find_delimiter(const char* p, const char* end) {
    if constexpr (kBlanksDelimit) {
      while (p != end && !is_blank(*p)) ++p;
      return p;
    }
    const void* found =
        std::memchr(p, static_cast<char>(kDelimiter), static_cast<std::size_t>(end - p));
    return found == nullptr ? end : static_cast<const char*>(found);
  }

  /// From behind the content of a cell to the delimiter that ends it; nullptr when more follows.
  static const char* finish_cell(const char* p, const char* end) {
    if constexpr (!kBlanksDelimit) p = skip_blanks(p, end);
    return p == end || is_delimiter(*p) ? p : nullptr;
  }
  /// From the end of a cell to the content of the next one; nullptr when there is no next one.
  static const char* next_cell(const char* p, const char* end) {
    if constexpr (kBlanksDelimit) {
      p = skip_blanks(p, end);
      return p == end ? nullptr : p;
    }
    return p == end ? nullptr : skip_blanks(p + 1, end);
  }
  /// Whether the cell that ends at `p` is the last one.
  static bool is_row_end(const char* p, const char* end) {
    if constexpr (kBlanksDelimit) p = skip_blanks(p, end);
    return p == end;
  }

  /// From an opening quote to behind the closing one; a doubled quote stands for itself.
  static const char* skip_quoted(const char* p, const char* end) {
    for (++p; p != end; ++p) {
      if (*p != '"') continue;
      if (p + 1 == end || p[1] != '"') return p + 1;
      ++p;
    }
    return nullptr;
  }

  static const char* skip_cell(const char* p, const char* end) {
    if (p == end || *p != '"') return find_delimiter(p, end);
    p = skip_quoted(p, end);
    return p == nullptr ? nullptr : finish_cell(p, end);
  }

  static const char* number_cell(const char* p, const char* end, double& value, char point) {
    const bool is_quoted = p != end && *p == '"';
    p = read_number(p + (is_quoted ? 1 : 0), end, value, point);
    if (p == nullptr) return nullptr;
    if (is_quoted && (p == end || *p++ != '"')) return nullptr;
    return finish_cell(p, end);
  }

  /// `text` points into the line, or into `scratch` when doubled quotes had to be resolved.
  static const char* text_cell(const char* p, const char* end, std::string_view& text,
                               std::string& scratch) {
    const char* const begin = p;
    p = skip_cell(p, end);
    if (p == nullptr) return nullptr;
    const char* last = p;
    while (last != begin && is_blank(last[-1])) --last;
    text = {begin, static_cast<std::size_t>(last - begin)};
    if (!text.starts_with('"')) return p;
    text = text.substr(1, text.size() - 2);
    if (text.find('"') != std::string_view::npos) text = scratch = without_doubled_quotes(text);
    return p;
  }
};

}  // namespace cablefit
