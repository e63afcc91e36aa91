// Names of table rows (effects, models, estimators, units, keys): an unknown one is an error that
// lists what exists and the nearest match.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace cablefit {

/// The known name within a small edit distance (Damerau-Levenshtein, at most a third of its
/// length) of `name`, or nothing. Case is ignored.
std::optional<std::string> nearest_name(std::string_view name,
                                        std::span<const std::string_view> known);

/// "did you mean 'x'?" when there is a near match, else "known: a, b, c" (all of them).
std::string suggestion(std::string_view name, std::span<const std::string_view> known);

/// Throws Error(input) "unknown <kind> 'name'" with a suggestion.
[[noreturn]] void fail_unknown_row(std::string_view kind, std::string_view name,
                                   std::span<const std::string_view> known);

/// The row of a table (anything with a member `name`) that is called so; fails as above when there
/// is none. `kind`: "cable law".
template <typename Row>
const Row& find_row(std::span<const Row> rows, std::string_view kind, std::string_view name) {
  std::vector<std::string_view> known;
  for (const Row& row : rows) {
    if (row.name == name) return row;
    known.push_back(row.name);
  }
  fail_unknown_row(kind, name, known);
}

}  // namespace cablefit
