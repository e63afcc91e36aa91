#include "cablefit/refine/verdict/separability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/refine/null/kept_effects.hpp"
#include "cablefit/refine/rows/recorded_effects.hpp"
#include "cablefit/refine/rows/refined_model.hpp"
#include "cablefit/refine/verdict/effect_distances.hpp"

namespace cablefit {
namespace {

constexpr double kAbsorbed = 1e-4;  // squared part that the base must leave of an effect
constexpr double kMaterial = 0.1;   // squared size of an effect that matters, in floors
constexpr double kClear = 16;       // squared sd between two explanations
constexpr double kTie = 0.02;       // what the verdict takes for a tie at any sd
constexpr double kSeparated = 1.5;  // times the least distance, for a run to be advised

using Group = std::vector<std::size_t>;

/// Effects that are all closer than `least` to each other, the closest first.
std::vector<Group> groups_of(const Distances& distances, const std::vector<std::size_t>& able,
                             double least) {
  struct Close {
    double distance;
    std::size_t a, b;
  };
  std::vector<Close> pairs;
  for (std::size_t i = 0; i < able.size(); ++i)
    for (std::size_t k = i + 1; k < able.size(); ++k)
      if (const double d = distances.between(able[i], able[k]); d < least)
        pairs.push_back({d, able[i], able[k]});
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Close& a, const Close& b) { return a.distance < b.distance; });
  const auto fits = [&](const Group& group, std::size_t f) {
    return std::all_of(group.begin(), group.end(), [&](std::size_t other) {
      return other == f || distances.between(other, f) < least;
    });
  };
  std::vector<Group> groups;
  for (const Close& pair : pairs) {
    const auto with = [&](std::size_t f, std::size_t other) {
      return std::find_if(groups.begin(), groups.end(), [&](Group& group) {
        const bool has = std::find(group.begin(), group.end(), f) != group.end();
        return has && fits(group, other);
      });
    };
    const auto has_both = std::any_of(groups.begin(), groups.end(), [&](const Group& group) {
      return std::find(group.begin(), group.end(), pair.a) != group.end() &&
             std::find(group.begin(), group.end(), pair.b) != group.end();
    });
    if (has_both) continue;
    if (const auto a = with(pair.a, pair.b); a != groups.end())
      a->push_back(pair.b);
    else if (const auto b = with(pair.b, pair.a); b != groups.end())
      b->push_back(pair.a);
    else
      groups.push_back({pair.a, pair.b});
  }
  return groups;
}

/// Whether no log of the usual kind separates any two of them.
bool are_aliases(const std::vector<Family>& families, const Group& group) {
  const std::string_view name = families[group.front()].row->alias_class;
  return !name.empty() && std::all_of(group.begin(), group.end(), [&](std::size_t f) {
    return families[f].row->alias_class == name;
  });
}

std::string name_with_site(const Effect& row) {
  return fmt::format("{} ({})", row.name, to_string(row.site));
}

/// One group, and whether it is from the base or from each other that it is not separable.
struct Open {
  Group group;  ///< of families
  bool from_base = false;
};

/// Pairs of a group that are still too close; of one effect alone: itself, from the base.
std::vector<std::pair<std::size_t, std::size_t>> still_close(const Open& open,
                                                             const std::vector<Family>& families,
                                                             const Distances& distances,
                                                             double least) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  const std::size_t first = open.group.front();
  if (open.from_base && distances.from_base(first) < kSeparated * kAbsorbed)
    pairs.emplace_back(first, first);
  for (const std::size_t a : open.group)
    for (const std::size_t b : open.group)
      if (a < b && !are_aliases(families, {a, b}) && distances.between(a, b) < least)
        pairs.emplace_back(a, b);
  return pairs;
}

/// The families that are in any group, the groups by their new numbers.
std::vector<Family> only_open(const std::vector<Family>& families, std::vector<Open>& open) {
  std::vector<Family> some;
  std::vector<std::size_t> number(families.size(), families.size());
  for (Open& one : open)
    for (std::size_t& f : one.group) {
      if (number[f] == families.size()) {
        number[f] = some.size();
        some.push_back(families[f]);
      }
      f = number[f];
    }
  return some;
}

/// For each group the first run that leaves the fewest pairs of it together.
void advise(std::vector<Open> open, const std::vector<Family>& all, const Design& design,
            const Eigen::VectorXd& values, const KindLevels& floor, double least,
            const std::vector<TrialRun>& runs, int threads, std::vector<NotSeparable>& out) {
  const Model model = recorded_models(models_with(design, values)).front();
  const std::vector<Family> families = only_open(all, open);
  if (families.empty()) return;
  const Products have = products_of(design, families, floor, values, nullptr, threads);
  const Distances now(have, families);
  std::vector<std::size_t> fewest;
  for (const Open& one : open) fewest.push_back(still_close(one, families, now, least).size());
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const auto stretch = simulated(runs[r], model);
    if (!stretch) continue;
    const Design trial = with_variants(make_design(design.models, {*stretch}, design.smoothing),
                                       design.added, values);
    if (trial.rows.front().kinds.front().response.size() == 0) continue;
    const Products more = products_of(trial, families, floor, values, &have, threads);
    const Distances distances(more, families);
    for (std::size_t k = 0; k < open.size(); ++k) {
      const auto close = still_close(open[k], families, distances, kSeparated * least);
      if (close.size() >= fewest[k]) continue;
      fewest[k] = close.size();
      out[k].run = static_cast<int>(r);
      out[k].next_run = text_of(runs[r], model.rig.axes.all());
      out[k].still_together.clear();
      for (const std::size_t f : open[k].group)
        if (std::any_of(close.begin(), close.end(),
                        [f](const auto& pair) { return pair.first == f || pair.second == f; }))
          out[k].still_together.push_back(name_with_site(*families[f].row));
    }
  }
}

}  // namespace

std::vector<NotSeparable> find_not_separable(const Design& design, const Eigen::VectorXd& x,
                                             const KindLevels& floor,
                                             const std::vector<TrialRun>& runs, int threads) {
  const Eigen::VectorXd values = x.head(design.n_columns());
  const std::vector<Family> families = families_of(design);
  const Products products = products_of(design, families, floor, values, nullptr, threads);
  const Distances distances(products, families);
  const double least = std::max(kTie, kClear / (kMaterial * products.n_rows));
  std::vector<Open> open;
  std::vector<std::size_t> able;
  for (std::size_t f = 0; f < families.size(); ++f) {
    if (!distances.is_there(f)) continue;
    // Other cables are not columns beside the base's, see try_variant.
    const double tolerance = replaces_rows(families[f].variants.front()) ? 1e-9 : kAbsorbed;
    if (distances.from_base(f) < tolerance)
      open.push_back({{f}, true});
    else
      able.push_back(f);
  }
  for (Group& group : groups_of(distances, able, least)) open.push_back({std::move(group), false});
  std::vector<NotSeparable> out;
  for (const Open& one : open) {
    NotSeparable& group = out.emplace_back();
    for (const std::size_t f : one.group) group.effects.push_back(name_with_site(*families[f].row));
    group.from_base = one.from_base;
    group.is_alias = are_aliases(families, one.group);
  }
  advise(std::move(open), families, design, values, floor, least, runs, threads, out);
  return out;
}

}  // namespace cablefit
