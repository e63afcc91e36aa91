// Names of table rows (effects, models, estimators, units, keys): an unknown one is an error that
// lists what exists and the nearest match.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace cablefit {

/// The known name within a small edit distance (Damerau-Levenshtein, at most a third of its
/// length) of `name`, or nothing. Case is ignored.
std::optional<std::string> nearest_name(std::string_view name,
                                        std::span<const std::string_view> known);

/// "did you mean 'x'?" when there is a near match, else "known: a, b, c" (all of them).
std::string suggestion(std::string_view name, std::span<const std::string_view> known);

}  // namespace cablefit
