#include "cablefit/campaign/compare/compared_pairs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/base/catalog.hpp"
#include "cablefit/base/error.hpp"
#include "cablefit/base/quote.hpp"
#include "cablefit/model/effects/effect_parameter.hpp"

namespace cablefit {
namespace {

using SetPointers = std::vector<const EstimateSet*>;

/// Distinct values of a text of the sets, in their order, without the empty one.
std::vector<std::string> distinct(const SetPointers& sets, std::string EstimateSet::*text) {
  std::vector<std::string> all;
  for (const EstimateSet* set : sets)
    if (!(set->*text).empty() && std::find(all.begin(), all.end(), set->*text) == all.end())
      all.push_back(set->*text);
  return all;
}

/// Those of a name; those without a name hold for all. Throws Error(usage) when none has it.
SetPointers sets_with(const RecordedResult& result, const SetPointers& sets,
                      std::string EstimateSet::*text, const std::string& name,
                      std::string_view what) {
  if (name.empty()) return sets;
  const std::vector<std::string> known = distinct(sets, text);
  if (std::find(known.begin(), known.end(), name) == known.end())
    throw usage_error(fmt::format("no {} {} in {}", what, in_quotes(name), result.path),
                      suggestion(name, std::vector<std::string_view>(known.begin(), known.end())));
  SetPointers chosen;
  for (const EstimateSet* set : sets)
    if ((set->*text).empty() || set->*text == name) chosen.push_back(set);
  return chosen;
}

SetPointers chosen_sets(const RecordedResult& result, const std::string& preload,
                        const std::string& model) {
  SetPointers sets;
  for (const EstimateSet& set : result.sets) sets.push_back(&set);
  sets = sets_with(result, sets, &EstimateSet::preload, preload, "preload");
  return sets_with(result, sets, &EstimateSet::model, model, "model");
}

/// Of several models of one stage and preload: what stage 1 chose in both, else the last (richest)
/// model that both have with the same order, else the last of each.
std::pair<const EstimateSet*, const EstimateSet*> best_pair(const SetPointers& first,
                                                            const SetPointers& second) {
  std::pair<const EstimateSet*, const EstimateSet*> best{first.back(), second.back()};
  const EstimateSet* selected = nullptr;
  for (const EstimateSet* a : first)
    for (const EstimateSet* b : second) {
      if (a->model != b->model || a->order != b->order || selected != nullptr) continue;
      best = {a, b};
      if (a->is_selected && b->is_selected) selected = a;
    }
  return best;
}

void pair_up(const EstimateSet& first, const EstimateSet& second, std::vector<EstimatePair>& pairs,
             std::vector<Uncompared>& alone) {
  for (const Estimate& a : first.estimates) {
    const Estimate* b = find_estimate(second.estimates, a.name);
    if (b != nullptr) {
      pairs.push_back({&first, &second, &a, b});
    } else {
      alone.push_back({first.preload, a.name, "only in the first result"});
    }
  }
  for (const Estimate& b : second.estimates)
    if (find_estimate(first.estimates, b.name) == nullptr)
      alone.push_back({second.preload, b.name, "only in the second result"});
}

/// Preloads and stages that only one of the results has.
void add_unpaired(const SetPointers& sets, const SetPointers& done, std::string_view which,
                  std::vector<Uncompared>& alone) {
  for (const EstimateSet* set : sets) {
    const bool met = std::any_of(done.begin(), done.end(), [&](const EstimateSet* other) {
      return other->stage == set->stage && other->preload == set->preload;
    });
    const bool is_listed = std::any_of(alone.begin(), alone.end(), [&](const Uncompared& one) {
      return one.preload == set->preload && one.name == set->stage;
    });
    if (!met && !is_listed)
      alone.push_back({set->preload, set->stage, fmt::format("only in the {} result", which)});
  }
}

/// Sets of the same stage and preload; `any_preload` takes those of any that has a name.
SetPointers group_of(const SetPointers& sets, const EstimateSet& like, bool any_preload) {
  SetPointers group;
  for (const EstimateSet* set : sets)
    if (set->stage == like.stage &&
        (any_preload ? set->preload.empty() == like.preload.empty() : set->preload == like.preload))
      group.push_back(set);
  return group;
}

}  // namespace

std::vector<EstimatePair> estimate_pairs(const RecordedResult& first, const RecordedResult& second,
                                         const CompareOptions& options,
                                         std::vector<Uncompared>& alone) {
  const SetPointers a = chosen_sets(first, options.first_preload, options.model);
  const SetPointers b = chosen_sets(second, options.second_preload, options.model);
  const bool only_ones = distinct(a, &EstimateSet::preload).size() == 1 &&
                         distinct(b, &EstimateSet::preload).size() == 1;
  std::vector<EstimatePair> pairs;
  SetPointers done, met_a, met_b;
  for (const EstimateSet* set : a) {
    if (std::find(done.begin(), done.end(), set) != done.end()) continue;
    const SetPointers mine = group_of(a, *set, false);
    done.insert(done.end(), mine.begin(), mine.end());
    const SetPointers theirs = group_of(b, *set, only_ones);
    if (theirs.empty()) continue;
    const auto [left, right] = best_pair(mine, theirs);
    met_a.push_back(left);
    met_b.push_back(right);
    pair_up(*left, *right, pairs, alone);
  }
  add_unpaired(a, met_a, "first", alone);
  add_unpaired(b, met_b, "second", alone);
  return pairs;
}

bool is_ideally_zero(std::string_view name) {
  const ParameterInfo* info = effect_parameter(name);
  return info != nullptr ? info->lower == -kUnbounded : name.substr(0, name.find('[')) == "theta_0";
}

double scale_of_zero(const EstimateSet& set, const Estimate& estimate) {
  const bool is_angle = estimate.unit == "rad" || estimate.unit == "m";
  return is_angle ? set.deflection_scale : set.torque_scale;
}

}  // namespace cablefit
