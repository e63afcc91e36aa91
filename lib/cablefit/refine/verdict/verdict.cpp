#include "cablefit/refine/verdict/verdict.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "cablefit/base/random.hpp"
#include "cablefit/refine/gap_levels.hpp"
#include "cablefit/refine/null/chance_gains.hpp"
#include "cablefit/refine/rows/levels.hpp"
#include "cablefit/refine/verdict/conclusion.hpp"

namespace cablefit {
namespace {

constexpr double kNextShare = 0.3;  // of the gap that is left
// The same of a line of many periods: no imperfect law repeats with the position that often.
constexpr double kLineShare = 0.05;
constexpr double kNextMateriality =
    0.02;                           // of what is left: imperfect first terms leave a small residual
constexpr double kLookAlikeSd = 2;  // paired blocks' difference
constexpr double kLookAlikeShare = 0.25;  // of the gap: more than that apart is not alike
constexpr double kTieShare = 0.02;        // of the gap: closer than that, either may be first
// Closer than that is alike at any sd: rounding and filters move a fit by as much (the true effect
// closed 3 % less than another in 2 of 68 cases at one load).
constexpr double kAlikeShare = 0.03;
constexpr double kEqualShare = 0.005;  // the same, where the blocks agree on which is better
constexpr double kSameShare = 0.001;   // closer than that: not separable with these logs
constexpr double kSureSd = 3;          // that they do
constexpr double kSafety = 1.3;        // times the largest chance gain seen
// What passes against its gain at half of all other dates. By chance the largest of 40 blocks'
// largest gains is 2 to 3 times their median (exponential tails; Fisher & Tippett 1928).
constexpr double kStandsOut = 4;
constexpr double kAtFloor = 0.1;  // of the significance, where there is no gap to explain
constexpr int kResamples = 200;

bool may_be_named(const Candidate& c) { return c.refused.empty() && c.gain > 0; }

/// Share of resamples of the blocks in which each candidate has the least error.
std::vector<double> inclusions(const std::vector<const Candidate*>& candidates) {
  std::vector<int> wins(candidates.size(), 0);
  if (candidates.empty()) return {};
  const Eigen::Index n = candidates.front()->error.size();
  Random random(1, 21);
  for (int resample = 0; resample < kResamples; ++resample) {
    Eigen::ArrayXd weight = Eigen::ArrayXd::Zero(n);
    for (Eigen::Index i = 0; i < n; ++i)
      weight(static_cast<Eigen::Index>(random.uniform() * static_cast<double>(n))) += 1;
    std::size_t best = 0;
    double least = kUnbounded;
    for (std::size_t k = 0; k < candidates.size(); ++k) {
      const double error = (weight * candidates[k]->error).sum();
      if (error < least) {
        least = error;
        best = k;
      }
    }
    ++wins[best];
  }
  std::vector<double> share;
  for (const int won : wins) share.push_back(static_cast<double>(won) / kResamples);
  return share;
}

std::size_t n_parameters(const Candidate& c) {
  const Variant& variant = c.variant;
  const Effect& row = *variant.effect;
  // Other cables may have more coefficients.
  std::size_t n = static_cast<std::size_t>(c.x.size()) + (row.is_event ? 1 : 0);
  for (std::size_t i = 0; i < row.shape.size(); ++i)
    n += row.shape[i].is_whole || is_free(variant, i) ? 1 : 0;
  return n;
}

/// In sample, or held out.
bool are_comparable(const Candidate& a, const Candidate& b) {
  return a.variant.effect->passes() == b.variant.effect->passes();
}

bool is_tie(const Candidate& a, const Candidate& b, const SquaredGap& gap) {
  if (!are_comparable(a, b)) return false;
  const Paired difference = paired(a.error, b.error);
  return difference.sum < kEqualShare * gap.above() ||
         (difference.sum < kTieShare * gap.above() && difference.in_sd() < kSureSd);
}

Rival rival_of(const Candidate& c, const SquaredGap& gap) {
  const Effect& row = *c.variant.effect;
  Rival rival;
  rival.name = row.name;
  rival.side = to_string(row.site);
  rival.gain = gap.above() > 0 ? c.gain * gap.total / gap.above() : 0;
  rival.refused = c.refused;
  rival.experiment = row.experiment;
  return rival;
}

/// What decides whether a gain is beyond chance. An event may not win by what any date of any event
/// would have won, and only where there is a gap: some log begins or ends unlike the simulated
/// ones.
class Significance {
 public:
  Significance(const std::vector<NullDraw>& draws, const SquaredGap& gap,
               const RefineOptions& options, bool is_first)
      : chance_(draws), gap_(gap), options_(options), is_first_(is_first) {}

  ChanceTail of_search(double gain) const { return chance_.tail_of_search(gain); }

  ChanceTail tail(const Candidate& c) const { return chance_.tail(*c.variant.effect, c.gain); }

  bool holds(const Candidate& c) const {
    const Effect& row = *c.variant.effect;
    const double least =
        is_first_ ? options_.materiality : std::max(kNextMateriality, options_.materiality);
    const double share = c.is_line ? kLineShare : kNextShare;
    if (!is_first_ && c.gain * gap_.total < share * gap_.above()) return false;
    if (row.is_event && is_at_floor()) return false;
    if (row.passes() && c.gain < kStandsOut * c.elsewhere) return false;
    return c.gain >= least && chance_.is_beyond(row, c.gain, kSafety) &&
           tail(c).p <= significance();
  }

  /// Whether more draws may change what holds() says: p is not ten times the significance or a
  /// tenth of it.
  bool is_open(const Candidate& c) const {
    constexpr double kFar = 10;
    const double p = tail(c).p;
    return p <= kFar * options_.significance &&
           p > std::max(least_tail(chance_.n_draws()), options_.significance / kFar);
  }

  double beyond_chance(const Candidate& c) const {
    return c.gain - chance_.usual(*c.variant.effect);
  }

 private:
  bool is_at_floor() const { return gap_.total < kNoGap * gap_.floor; }

  /// Most logs in which nothing is missing are at the floor, and few in which something is: a name
  /// there has the odds against it.
  double significance() const {
    if (!is_at_floor()) return options_.significance;
    return std::max(least_tail(options_.n_draws), kAtFloor * options_.significance);
  }

  ChanceGains chance_;
  const SquaredGap& gap_;
  const RefineOptions& options_;
  bool is_first_;
};

/// Physical candidates with a gain, the largest first.
std::vector<const Candidate*> ranked(const std::vector<Candidate>& candidates) {
  std::vector<const Candidate*> able;
  for (const Candidate& c : candidates)
    if (may_be_named(c)) able.push_back(&c);
  std::stable_sort(able.begin(), able.end(),
                   [](const Candidate* a, const Candidate* b) { return a->gain > b->gain; });
  return able;
}

bool is_of_sensor(const Candidate& c) { return c.variant.effect->site == Site::sensor; }

/// Of two that tie: the one with fewer parameters, and what acts on the robot before what a sensor
/// only reads, as a constant torque before a wrong zero of an encoder.
bool is_simpler(const Candidate& a, const Candidate& b) {
  if (n_parameters(a) != n_parameters(b)) return n_parameters(a) < n_parameters(b);
  return !is_of_sensor(a) && is_of_sensor(b);
}

/// Of two effects that are not separable with these logs, the one that is more common in cable
/// drives. It comes first in the catalogue.
bool is_commoner(const Candidate& a, const Candidate& b, const SquaredGap& gap) {
  const Effect &row = *a.variant.effect, &other = *b.variant.effect;
  return are_comparable(a, b) && row.site == other.site && n_parameters(a) == n_parameters(b) &&
         std::abs(paired(a.error, b.error).sum) < kSameShare * gap.above() && &row < &other;
}

/// Whether the other effect is the better answer: it gains more beyond the null, or as much and is
/// the simpler one. Where neither is an event, their gains are not compared with those of their own
/// rows under the null. Otherwise, of two effects that are nearly the same, the one with the larger
/// gain under the null would lose.
bool is_better_name(const Candidate& other, const Candidate& best, const Significance& significance,
                    const SquaredGap& gap) {
  if (is_tie(other, best, gap) && is_simpler(other, best)) return true;
  if (is_commoner(other, best, gap)) return true;
  if (!other.variant.effect->is_event && !best.variant.effect->is_event)
    return other.gain > best.gain;
  return significance.beyond_chance(other) > significance.beyond_chance(best);
}

/// Place of the significant candidate with the best name; what is always there is compared first.
/// Nothing: none is significant.
std::optional<std::size_t> best_of(const std::vector<const Candidate*>& able,
                                   const Significance& significance, const SquaredGap& gap) {
  std::optional<std::size_t> best;
  for (const bool is_event : {false, true})
    for (std::size_t k = 0; k < able.size(); ++k) {
      if (able[k]->variant.effect->is_event != is_event || !significance.holds(*able[k])) continue;
      if (!best || is_better_name(*able[k], *able[*best], significance, gap)) best = k;
    }
  return best;
}

/// Whether the data leave it open which of the two it is. More parameters that do no better are no
/// other explanation.
bool is_alike(const Candidate& c, const Candidate& best, const Paired& difference,
              const SquaredGap& gap) {
  if (!are_comparable(c, best)) return false;
  if (n_parameters(c) > n_parameters(best) && difference.sum >= 0) return false;
  const double apart = gap.above() > 0 ? difference.sum / gap.above() : kUnbounded;
  return apart < kAlikeShare ||
         (difference.sum < kLookAlikeSd * difference.se && apart < kLookAlikeShare);
}

/// Aliases are listed by rule, also where their columns vanished beside each other.
void add_aliases(const Effect& named, std::vector<Rival>& rivals) {
  for (const Effect& row : candidate_effects()) {
    if (&row == &named || !same_class(row, named)) continue;
    const bool there = std::any_of(rivals.begin(), rivals.end(), [&](const Rival& r) {
      return r.name == row.name && r.side == to_string(row.site);
    });
    if (there) continue;
    Rival& rival = rivals.emplace_back();
    rival.name = row.name;
    rival.side = to_string(row.site);
    rival.by_rule = true;
    rival.experiment = row.experiment;
  }
}

std::vector<Rival> rivals_of(const Candidate& best, const std::vector<const Candidate*>& able,
                             const std::vector<double>& share, const SquaredGap& gap) {
  const Effect& named = *best.variant.effect;
  std::vector<Rival> rivals;
  for (std::size_t k = 0; k < able.size(); ++k) {
    const Effect& row = *able[k]->variant.effect;
    if (&row == &named) continue;
    const Paired difference = paired(able[k]->error, best.error);
    const bool by_rule = same_class(row, named);
    if (!by_rule && !is_alike(*able[k], best, difference, gap)) continue;
    Rival& rival = rivals.emplace_back(rival_of(*able[k], gap));
    rival.inclusion = share[k];
    rival.by_rule = by_rule;
    rival.difference = difference.in_sd();
  }
  add_aliases(named, rivals);
  return rivals;
}

/// All rows, those that were refused last.
std::vector<Rival> ranking_of(const std::vector<Candidate>& candidates,
                              const std::vector<const Candidate*>& able,
                              const std::vector<double>& share, const SquaredGap& gap) {
  std::vector<Rival> ranking;
  for (std::size_t k = 0; k < able.size(); ++k) {
    ranking.push_back(rival_of(*able[k], gap));
    ranking.back().inclusion = share[k];
  }
  for (const Candidate& c : candidates)
    if (!may_be_named(c)) ranking.push_back(rival_of(c, gap));
  return ranking;
}

}  // namespace

Judgement judge_search(const std::vector<Candidate>& candidates, const SquaredGap& gap,
                       const std::vector<NullDraw>& draws, const RefineOptions& options,
                       bool is_first) {
  const std::vector<const Candidate*> able = ranked(candidates);
  const std::vector<double> share = inclusions(able);
  Judgement judgement;
  judgement.ranking = ranking_of(candidates, able, share, gap);
  const Significance significance(draws, gap, options, is_first);
  const auto first = std::find_if(able.begin(), able.end(),
                                  [](const Candidate* c) { return !c->variant.effect->is_event; });
  if (first != able.end()) judgement.search = significance.of_search((*first)->gain);
  const auto best = best_of(able, significance, gap);
  const double least_gain = best ? able[*best]->gain : 0;
  judgement.is_settled = std::none_of(able.begin(), able.end(), [&](const Candidate* c) {
    return c->gain >= least_gain && significance.is_open(*c);
  });
  if (!best) return judgement;
  judgement.is_named = true;
  judgement.best = able[*best];
  judgement.chance = significance.tail(*judgement.best);
  judgement.inclusion = share[*best];
  judgement.rivals = rivals_of(*judgement.best, able, share, gap);
  for (std::size_t k = 0; k < able.size(); ++k)  // the ranking begins with these
    judgement.ranking[k].difference = paired(able[k]->error, judgement.best->error).in_sd();
  return judgement;
}

Judgement judge_candidate(const Candidate& candidate, const std::vector<Candidate>& candidates,
                          const SquaredGap& gap, const std::vector<NullDraw>& draws,
                          const RefineOptions& options) {
  const std::vector<const Candidate*> able = ranked(candidates);
  const std::vector<double> share = inclusions(able);
  Judgement judgement;
  judgement.is_named = true;
  const Significance significance(draws, gap, options, true);
  judgement.chance = significance.tail(candidate);
  judgement.rivals = rivals_of(candidate, able, share, gap);
  for (std::size_t k = 0; k < able.size(); ++k)
    if (able[k]->variant.effect == candidate.variant.effect) judgement.inclusion = share[k];
  return judgement;
}

}  // namespace cablefit
