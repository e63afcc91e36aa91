#include "cablefit/log/column_header.hpp"

#include <algorithm>
#include <string>
#include <unordered_set>

#include "cablefit/base/quote.hpp"
#include "cablefit/base/trim.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kMaxNameBytes = 1000;

// Offset of the bracket that the last byte of `text` closes, npos when there is none.
std::size_t opening_bracket(std::string_view text) {
  if (text.empty()) return std::string_view::npos;
  const char closing = text.back();
  const char opening = closing == ']' ? '[' : closing == ')' ? '(' : '\0';
  int depth = 0;
  for (std::size_t i = text.size(); opening != '\0' && i-- > 0;) {
    if (text[i] == closing) ++depth;
    if (text[i] == opening && --depth == 0) return i;
  }
  return std::string_view::npos;
}

bool is_index(std::string_view name, std::string_view bracketed) {
  const bool is_attached = !name.empty() && name.back() != ' ' && name.back() != '\t';
  return is_attached && bracketed.find_first_not_of("0123456789") == std::string_view::npos;
}

}  // namespace

ColumnHeader to_column_header(std::string_view text, const Place& place) {
  const std::string_view cell = trimmed(text);
  const std::size_t bracket = opening_bracket(cell);
  const bool has_bracket = bracket != std::string_view::npos && bracket > 0;
  if (!has_bracket) return {std::string(cell), {}, place};
  const std::string_view name = cell.substr(0, bracket);
  const std::string_view unit = cell.substr(bracket + 1, cell.size() - bracket - 2);
  if (is_index(name, unit)) return {std::string(cell), {}, place};
  return {std::string(trimmed(name)), std::string(trimmed(unit)), place};
}

void check_name_length(std::string_view text, const Place& place) {
  if (text.size() <= kMaxNameBytes) return;
  throw input_error(place, in_quotes(text) + " is longer than 1000 bytes", "is this a log?");
}

void check_names(const std::vector<ColumnHeader>& columns, const Place& header_place) {
  std::unordered_set<std::string_view> names;
  for (const ColumnHeader& column : columns) {
    if (column.name.empty() || names.insert(column.name).second) continue;
    throw input_error(column.place, "column " + in_quotes(column.name) + " appears twice",
                      "rename one of them");
  }
  if (names.empty()) {
    throw input_error(header_place, "no column names", "name the columns, as t,q,theta,tau");
  }
}

}  // namespace cablefit
