// The decision rule on what a search found: what may be named, by which evidence, beside which
// similar effects. Whether an effect stays is decided in conclusion.hpp. Internal to refine/.
#pragma once

#include "cablefit/refine/null/chance_tail.hpp"
#include "cablefit/refine/null/null_draws.hpp"
#include "cablefit/refine/refine_options.hpp"
#include "cablefit/refine/refine_result.hpp"
#include "cablefit/refine/search/search.hpp"

namespace cablefit {

/// Result of one search.
struct Judgement {
  const Candidate* best = nullptr;  ///< the largest gain of all that may be named; nullptr: none
  ChanceTail chance;                ///< of the best
  ChanceTail search;                ///< of the largest gain of what is always there, named or not
  bool is_settled = true;  ///< more draws would hardly change whether something is named, and what
  bool is_named = false;
  std::vector<Rival> rivals;   ///< effects similar to the best, likeliest first
  std::vector<Rival> ranking;  ///< all rows, by gain
  double inclusion = 0;
};

/// Squared held-out error of the base, and how much of it noise alone would leave (both weighted).
struct SquaredGap {
  double total = 0, floor = 0;
  double above() const { return std::max(0.0, total - floor); }
};

/// `is_first`: a further effect has to carry more.
Judgement judge_search(const std::vector<Candidate>& candidates, const SquaredGap& gap,
                       const std::vector<NullDraw>& draws, const RefineOptions& options,
                       bool is_first);

/// The same of one of the candidates, whether or not it is the best.
Judgement judge_candidate(const Candidate& candidate, const std::vector<Candidate>& candidates,
                          const SquaredGap& gap, const std::vector<NullDraw>& draws,
                          const RefineOptions& options);

}  // namespace cablefit
