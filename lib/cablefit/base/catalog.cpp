#include "cablefit/base/catalog.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <vector>

#include "cablefit/base/error.hpp"
#include "cablefit/base/quote.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kMostListed = 20;
constexpr std::size_t kMaxNameBytes = 200;  // the distance costs the product of both lengths

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

// Damerau-Levenshtein distance in its usual form (optimal string alignment): insertions, deletions,
// substitutions and swaps of neighbours count 1 each. Only the last three rows are kept.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before_previous(b.size() + 1), previous(b.size() + 1),
      current(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) current[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before_previous.swap(previous);
    previous.swap(current);
    current[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = previous[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      current[j] = std::min({previous[j] + 1, current[j - 1] + 1, substituted});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) current[j] = std::min(current[j], before_previous[j - 2] + 1);
    }
  }
  return current[b.size()];
}

}  // namespace

std::optional<std::string> nearest_name(std::string_view name,
                                        std::span<const std::string_view> known) {
  if (name.size() > kMaxNameBytes) return std::nullopt;
  const std::string wanted = lower_case(name);
  std::optional<std::string> nearest;
  std::size_t nearest_distance = 0;
  for (const std::string_view candidate : known) {
    const std::size_t distance = edit_distance(wanted, lower_case(candidate));
    const bool is_near = distance <= candidate.size() / 3;
    if (is_near && (!nearest || distance < nearest_distance)) {
      nearest = candidate;
      nearest_distance = distance;
    }
  }
  return nearest;
}

std::string suggestion(std::string_view name, std::span<const std::string_view> known) {
  if (const auto nearest = nearest_name(name, known)) {
    return fmt::format("did you mean '{}'?", *nearest);
  }
  std::vector<std::string> listed;
  for (const std::string_view each : known.first(std::min(known.size(), kMostListed))) {
    listed.push_back(shortened(each));
  }
  if (known.size() > kMostListed) {
    listed.push_back(fmt::format("... ({} more)", known.size() - kMostListed));
  }
  return fmt::format("known: {}", fmt::join(listed, ", "));
}

void fail_unknown_row(std::string_view kind, std::string_view name,
                      std::span<const std::string_view> known) {
  throw input_error({}, fmt::format("unknown {} '{}'", kind, name), suggestion(name, known));
}

}  // namespace cablefit
