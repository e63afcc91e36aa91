// The decision rule for the results of a search: which effect may be identified, by which evidence,
// and with which similar effects. conclusion.hpp decides whether an effect stays. Internal to
// refine/.
#pragma once

#include "cablefit/refine/null/chance_tail.hpp"
#include "cablefit/refine/null/null_draws.hpp"
#include "cablefit/refine/refine_options.hpp"
#include "cablefit/refine/refine_result.hpp"
#include "cablefit/refine/search/search.hpp"

namespace cablefit {

/// The outcome of one search.
struct Judgement {
  const Candidate* best = nullptr;  ///< the largest gain that may be identified; nullptr: none
  ChanceTail chance;                ///< of the best
  ChanceTail search;       ///< of the largest gain of effects that are no events, identified or not
  bool is_settled = true;  ///< more draws would hardly change the outcome
  bool is_named = false;
  std::vector<Rival> rivals;   ///< effects similar to the best, likeliest first
  std::vector<Rival> ranking;  ///< all rows, by gain
  double inclusion = 0;
};

/// Squared held-out error of the base, and the part of it from noise alone (both weighted).
struct SquaredGap {
  double total = 0, floor = 0;
  double above() const { return std::max(0.0, total - floor); }
};

/// `is_first`: false requires more evidence, for a further effect.
Judgement judge_search(const std::vector<Candidate>& candidates, const SquaredGap& gap,
                       const std::vector<NullDraw>& draws, const RefineOptions& options,
                       bool is_first);

/// As above, for one of the candidates, even when it is not the best.
Judgement judge_candidate(const Candidate& candidate, const std::vector<Candidate>& candidates,
                          const SquaredGap& gap, const std::vector<NullDraw>& draws,
                          const RefineOptions& options);

}  // namespace cablefit
