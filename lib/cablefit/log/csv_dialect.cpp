#include "cablefit/log/csv_dialect.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "cablefit/base/trim.hpp"

namespace cablefit {
namespace {

constexpr std::size_t npos = std::string_view::npos;

// Brackets and quotes that close further away than this are ordinary text. Without a bound a
// hostile header would cost the square of its length.
constexpr std::size_t kMaxBracketBytes = 256;
constexpr std::size_t kMaxQuotedBytes = 4096;

bool is_delimiter(char c, Delimiter delimiter) {
  if (delimiter == Delimiter::blanks) return c == ' ' || c == '\t';
  return c == static_cast<char>(delimiter);
}

std::size_t skip_blanks(std::string_view line, std::size_t at, Delimiter delimiter) {
  const std::string_view blanks = delimiter == Delimiter::tab ? " " : " \t";
  return std::min(line.find_first_not_of(blanks, at), line.size());
}

// Offset of the bracket that closes the one at `at`, npos when `at` opens none or it stays open.
std::size_t closing_bracket(std::string_view line, std::size_t at) {
  if (at >= line.size() || (line[at] != '[' && line[at] != '(')) return npos;
  const char opening = line[at];
  const char closing = opening == '[' ? ']' : ')';
  const std::size_t end = std::min(line.size(), at + kMaxBracketBytes);
  int depth = 0;
  for (std::size_t i = at; i < end; ++i) {
    if (line[i] == opening) ++depth;
    if (line[i] == closing && --depth == 0) return i;
  }
  return npos;
}

// Offset of the quote that closes the one at `at`; a doubled quote stands for itself.
std::size_t closing_quote(std::string_view line, std::size_t at) {
  if (at >= line.size() || line[at] != '"') return npos;
  line = line.substr(0, at + kMaxQuotedBytes);
  for (std::size_t i = line.find('"', at + 1); i != npos; i = line.find('"', i + 2)) {
    if (i + 1 == line.size() || line[i + 1] != '"') return i;
  }
  return npos;
}

// Where the cell that begins at `at` ends.
std::size_t plain_cell_end(std::string_view line, std::size_t at, Delimiter delimiter) {
  while (at < line.size() && !is_delimiter(line[at], delimiter)) ++at;
  return at;
}

// The same, with delimiters inside brackets belonging to the cell.
std::size_t header_cell_end(std::string_view line, std::size_t at, Delimiter delimiter) {
  while (at < line.size()) {
    const bool at_delimiter = is_delimiter(line[at], delimiter);
    if (at_delimiter && delimiter != Delimiter::blanks) return at;
    const std::size_t bracket = at_delimiter ? skip_blanks(line, at, delimiter) : at;
    const std::size_t closing = closing_bracket(line, bracket);
    if (at_delimiter && closing == npos) return at;
    at = closing == npos ? at + 1 : closing + 1;
  }
  return at;
}

// A quoted cell, unless something other than a delimiter follows its closing quote.
std::optional<Cell> take_quoted(std::string_view line, std::size_t& at, Delimiter delimiter) {
  const std::size_t closing = closing_quote(line, at);
  if (closing == npos) return std::nullopt;
  std::size_t end = closing + 1;
  if (delimiter != Delimiter::blanks) end = skip_blanks(line, end, delimiter);
  if (end < line.size() && !is_delimiter(line[end], delimiter)) return std::nullopt;
  const std::size_t begin = at;
  at = end;
  return Cell{without_doubled_quotes(line.substr(begin + 1, closing - begin - 1)), begin};
}

using FindCellEnd = std::size_t (*)(std::string_view line, std::size_t at, Delimiter delimiter);

std::vector<Cell> split(std::string_view line, Delimiter delimiter, FindCellEnd find_cell_end,
                        std::size_t n_max) {
  if (delimiter == Delimiter::blanks) line = line.substr(0, line.find_last_not_of(" \t") + 1);
  std::vector<Cell> cells;
  for (std::size_t at = 0; cells.size() < n_max; ++at) {  // ++ steps over the delimiter
    at = skip_blanks(line, at, delimiter);
    if (auto cell = take_quoted(line, at, delimiter)) {
      cells.push_back(std::move(*cell));
    } else {
      const std::size_t end = find_cell_end(line, at, delimiter);
      cells.push_back({std::string(trimmed(line.substr(at, end - at))), at});
      at = end;
    }
    if (at >= line.size()) break;
  }
  return cells;
}

}  // namespace

Delimiter find_delimiter(std::string_view header_line) {
  constexpr std::array candidates{Delimiter::comma, Delimiter::semicolon, Delimiter::tab};
  std::array<std::size_t, candidates.size()> counts{};
  for (std::size_t at = 0; at < header_line.size(); ++at) {
    const std::size_t bracket = closing_bracket(header_line, at);
    const std::size_t closing = bracket != npos ? bracket : closing_quote(header_line, at);
    if (closing != npos) at = closing;
    for (std::size_t k = 0; k < candidates.size(); ++k) {
      if (header_line[at] == static_cast<char>(candidates[k])) ++counts[k];
    }
  }
  const auto most = std::max_element(counts.begin(), counts.end());
  if (*most == 0) return Delimiter::blanks;
  return candidates[static_cast<std::size_t>(most - counts.begin())];
}

std::vector<Cell> split_header(std::string_view line, Delimiter delimiter, std::size_t n_max) {
  return split(line, delimiter, header_cell_end, n_max);
}

std::vector<Cell> split_row(std::string_view line, Delimiter delimiter) {
  return split(line, delimiter, plain_cell_end, npos);
}

std::string without_doubled_quotes(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    plain += text[i];
    if (text[i] == '"') ++i;  // the second one of a pair
  }
  return plain;
}

bool is_skipped_line(std::string_view line, Delimiter delimiter) {
  const std::size_t first = skip_blanks(line, 0, delimiter);
  return first == line.size() || line[first] == '#';
}

}  // namespace cablefit
