#include "cablefit/refine/verdict/inseparable_rivals.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace cablefit {
namespace {

constexpr double kNearly = 0.1;  // of the squared gap, or of the squared floor where that is larger

std::string name_of(const std::string& name, std::string_view side) {
  return fmt::format("{} ({})", name, side);
}

bool has(const NotSeparable& group, const std::string& name) {
  return std::find(group.effects.begin(), group.effects.end(), name) != group.effects.end();
}

/// The parameters of the model take nearly all of this effect.
bool is_nearly_in_model(const RefineResult& result, const std::string& named) {
  return std::any_of(result.not_separable.begin(), result.not_separable.end(),
                     [&](const NotSeparable& group) {
                       return group.from_base && !group.is_alias && has(group, named);
                     });
}

bool is_listed(const NamedEffect& effect, const Rival& candidate) {
  return std::any_of(effect.rivals.begin(), effect.rivals.end(), [&](const Rival& rival) {
    return rival.name == candidate.name && rival.side == candidate.side;
  });
}

}  // namespace

void add_inseparable_rivals(RefineResult& result) {
  if (result.effects.empty()) return;
  NamedEffect& first = result.effects.front();
  const Effect& row = *first.instance.effect;
  const std::string named = name_of(std::string(row.name), to_string(row.site));
  const auto own = std::find_if(result.ranking.begin(), result.ranking.end(),
                                [&](const Rival& c) { return name_of(c.name, c.side) == named; });
  if (own == result.ranking.end()) return;
  const double gap = first.evidence.rho_before - 1;  // in squared floors
  const double nearly = gap > 0 ? kNearly * std::max(1.0, 1 / gap) : 0;
  const bool nearly_in_model = is_nearly_in_model(result, named);
  for (const Rival& candidate : result.ranking) {
    const std::string name = name_of(candidate.name, candidate.side);
    if (!candidate.refused.empty() || name == named || is_listed(first, candidate) ||
        candidate.gain < own->gain - nearly)
      continue;
    const bool in_one_group = std::any_of(
        result.not_separable.begin(), result.not_separable.end(), [&](const NotSeparable& group) {
          return !group.from_base && has(group, named) && has(group, name);
        });
    if (in_one_group || nearly_in_model) first.rivals.push_back(candidate);
  }
}

}  // namespace cablefit
