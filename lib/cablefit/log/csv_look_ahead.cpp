#include "cablefit/log/csv_look_ahead.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "cablefit/base/units.hpp"
#include "cablefit/log/csv_row.hpp"
#include "cablefit/log/iso_time.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kFewestNames = 2;        // of a header behind a preamble
constexpr std::size_t kLongestPreamble = 200;  // lines

bool is_point_number(std::string_view text) {
  double value = 0;
  const char* end = text.data() + text.size();
  return read_number(text.data(), end, value) == end;
}

bool is_value(const Cell& cell) {
  return is_point_number(cell.text) || is_decimal_comma_number(cell.text) ||
         is_missing_cell(cell.text) || read_iso_time(cell.text).has_value();
}

bool is_blank(const Cell& cell) { return cell.text.empty(); }

bool is_unit(const Cell& cell) {
  std::string_view text = cell.text;
  const bool bracketed = text.size() > 2 && (text.front() == '[' || text.front() == '(');
  if (bracketed) text = text.substr(1, text.size() - 2);
  if (text.empty() || text == "-" || text == "1") return true;
  try {
    parse_unit(text);
    return true;
  } catch (const Error&) {
    return false;
  }
}

bool any_value(const std::vector<Cell>& cells) {
  return std::any_of(cells.begin(), cells.end(),
                     [](const Cell& cell) { return is_value(cell) && !is_blank(cell); });
}

/// Whether `lines[k]` names the columns of the rows behind it.
bool names_columns(const std::vector<NumberedLine>& lines, std::size_t k) {
  const Delimiter delimiter = find_delimiter(lines[k].text);
  const std::vector<Cell> names = split_row(lines[k].text, delimiter);
  if (names.size() < kFewestNames || any_value(names)) return false;
  for (std::size_t next = k + 1; next < std::min(k + 3, lines.size()); ++next) {
    const std::vector<Cell> cells = split_row(lines[next].text, delimiter);
    if (cells.size() != names.size()) return false;
    if (any_value(cells)) return true;  // else a row of units may stand between
  }
  return false;
}

}  // namespace

std::vector<NumberedLine> content_lines(std::string_view text, std::uint64_t first) {
  std::vector<NumberedLine> lines;
  for (std::size_t begin = 0; begin < text.size(); ++first) {
    const std::size_t end = text.find('\n', begin);
    if (end == std::string_view::npos && !lines.empty()) break;
    std::string_view line = text.substr(begin, end == std::string_view::npos ? end : end - begin);
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (!is_skipped_line(line, Delimiter::blanks)) lines.push_back({line, first});
    begin = end == std::string_view::npos ? text.size() : end + 1;
  }
  return lines;
}

std::optional<Error> header_complaint(const NumberedLine& header,
                                      const std::vector<NumberedLine>& lines,
                                      const std::string& path) {
  if (lines.empty()) return std::nullopt;
  const Delimiter delimiter = find_delimiter(header.text);
  const std::vector<Cell> first = split_row(lines.front().text, delimiter);
  const std::size_t n_names = split_header(header.text, delimiter, first.size() + 1).size();
  if (n_names == first.size() && any_value(first)) return std::nullopt;
  if (std::all_of(first.begin(), first.end(), is_blank)) return std::nullopt;
  if (n_names == first.size() && std::all_of(first.begin(), first.end(), is_unit))
    return input_error({path, lines.front().number}, "this line holds units, not numbers",
                       "read it as units with --units-row");
  const std::size_t n_looked_at = std::min(kLongestPreamble, lines.size());
  for (std::size_t k = 0; k < n_looked_at; ++k)
    if (names_columns(lines, k))
      return input_error(
          {path, header.number},
          fmt::format("this line is not the header; line {} names the columns", lines[k].number),
          fmt::format("skip the lines before it with --skip {}", lines[k].number - 1));
  return std::nullopt;
}

bool has_decimal_commas(const std::vector<NumberedLine>& lines, Delimiter delimiter) {
  if (delimiter == Delimiter::comma) return false;
  bool found = false;
  for (const NumberedLine& line : lines)
    for (const Cell& cell : split_row(line.text, delimiter)) {
      if (cell.text.find('.') != std::string::npos && is_point_number(cell.text)) return false;
      found = found || is_decimal_comma_number(cell.text);
    }
  return found;
}

bool is_decimal_comma_number(std::string text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos) return false;
  text[comma] = '.';
  return is_point_number(text);
}

bool is_missing_cell(std::string_view text) {
  constexpr std::array words = {"nan", "na", "n/a", "null", "none", "-", "--"};
  const auto same = [&](std::string_view word) {
    return std::equal(text.begin(), text.end(), word.begin(), word.end(), [](char a, char b) {
      return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == b;
    });
  };
  return text.empty() || std::any_of(words.begin(), words.end(), same);
}

}  // namespace cablefit
