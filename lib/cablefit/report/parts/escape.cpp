#include "cablefit/report/parts/escape.hpp"

#include <fast_float/fast_float.h>

#include <algorithm>

namespace cablefit {
namespace {

bool is_number(std::string_view text) {
  double ignored = 0;
  const char* end = text.data() + text.size();
  const auto result = fast_float::from_chars(text.data(), end, ignored);
  return result.ec == std::errc() && result.ptr == end;
}

bool looks_like_formula(std::string_view text) {
  if (text.empty()) return false;
  const bool suspicious = std::string_view("=+-@\t\r").find(text.front()) != std::string_view::npos;
  return suspicious && !is_number(text);
}

/// Markdown's own characters. Brackets stay, they are frequent in units; a link needs "](".
std::string_view markdown_escape(char c) {
  switch (c) {
    case '|':
      return "\\|";
    case '\\':
      return "\\\\";
    case '`':
      return "\\`";
    case '*':
      return "\\*";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '&':
      return "&amp;";
    default:
      return "";
  }
}

}  // namespace

std::size_t n_characters(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return !is_continuation(c); }));
}

std::string csv_cell(std::string_view text) {
  std::string cell = looks_like_formula(text) ? "'" : "";
  cell += text;
  if (cell.find_first_of(",\"\r\n") == std::string::npos) return cell;
  std::string in_quotes = "\"";
  for (const char c : cell) {
    if (c == '"') in_quotes += '"';
    in_quotes += c;
  }
  return in_quotes + "\"";
}

std::string markdown_text(std::string_view text) {
  std::string escaped;
  for (const char c : printable(text)) {
    const std::string_view replacement = markdown_escape(c);
    if (!replacement.empty()) {
      escaped += replacement;
    } else if (c == '(' && !escaped.empty() && escaped.back() == ']') {
      escaped += "\\(";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

}  // namespace cablefit
