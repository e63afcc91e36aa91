#include "cablefit/refine/search/search.hpp"

#include <algorithm>

#include "cablefit/base/error.hpp"
#include "cablefit/refine/rows/levels.hpp"

namespace cablefit {
namespace {

constexpr double kSameLevel = 1.1;  // weights this close decide alike

bool is_same(const KindLevels& a, const KindLevels& b) {
  for (std::size_t k = 0; k < kRowKinds; ++k)
    if (a[k] > kSameLevel * b[k] || b[k] > kSameLevel * a[k]) return false;
  return true;
}

}  // namespace

bool same_class(const Effect& a, const Effect& b) {
  const bool other_axis = (a.site == Site::link && b.site == Site::motor) ||
                          (a.site == Site::motor && b.site == Site::link);
  return !a.alias_class.empty() && a.alias_class == b.alias_class && !other_axis;
}

std::vector<const Effect*> named_already(const Design& design) {
  std::vector<const Effect*> out;
  for (const Variant& variant : design.added)
    for (const Effect& row : candidate_effects()) {
      const Effect& named = *variant.effect;
      if (&row == &named || same_class(row, named)) out.push_back(&row);
    }
  return out;
}

const Candidate* best_lasting(const std::vector<Candidate>& candidates) {
  const Candidate* best = nullptr;
  for (const Candidate& c : candidates)
    if (c.refused.empty() && !c.variant.effect->is_event && c.gain > 0 &&
        (best == nullptr || c.gain > best->gain))
      best = &c;
  return best;
}

std::vector<const Candidate*> best_candidates(const std::vector<Candidate>& candidates,
                                              std::size_t most, const Effect& but) {
  const auto are_one = [](const Effect& a, const Effect& b) {
    return &a == &b || same_class(a, b);
  };
  std::vector<const Candidate*> all, best;
  for (const Candidate& c : candidates)
    if (c.refused.empty() && !c.variant.effect->is_event && c.gain > 0) all.push_back(&c);
  std::stable_sort(all.begin(), all.end(),
                   [](const Candidate* a, const Candidate* b) { return a->gain > b->gain; });
  for (const Candidate* c : all) {
    const Effect& row = *c->variant.effect;
    const bool again = std::any_of(best.begin(), best.end(), [&](const Candidate* other) {
      return are_one(row, *other->variant.effect);
    });
    if (best.size() < most && !again && !are_one(row, but)) best.push_back(c);
  }
  return best;
}

Search search(const Design& design, const KindLevels& floor, const ScanSettings& settings) {
  constexpr int kPasses = 2;
  Search s;
  s.levels = floor;
  s.grams = block_grams(design, settings.block_seconds);
  const auto without = named_already(design);
  for (int pass = 0; pass < kPasses; ++pass) {
    auto fit = fit_blocks(s.grams, s.levels);
    if (!fit)
      throw Error(ErrorKind::not_identifiable, "the logs do not determine the model's parameters");
    s.fit = std::move(*fit);
    s.candidates = scan({design, s.grams, s.fit, s.levels}, settings, without);
    // An event wins by its own null only; it does not set weights.
    const Candidate* best = best_lasting(s.candidates);
    const KindLevels left = at_least(best != nullptr ? best->rms : s.fit.rms(), floor);
    if (is_same(left, s.levels) || pass + 1 == kPasses) break;
    s.levels = left;
  }
  return s;
}

}  // namespace cablefit
