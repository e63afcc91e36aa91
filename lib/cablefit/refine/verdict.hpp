// The decision rule of refine, all of it. Internal to refine/.
#pragma once

#include "cablefit/refine/chance_tail.hpp"
#include "cablefit/refine/confirm.hpp"
#include "cablefit/refine/null_draws.hpp"
#include "cablefit/refine/refine.hpp"
#include "cablefit/refine/scan.hpp"

namespace cablefit {

/// What one search tells.
struct Judgement {
  const Candidate* best = nullptr;  ///< the largest gain of all that may be named; nullptr: none
  ChanceTail chance;
  bool is_named = false;
  std::vector<Rival> rivals;  ///< look-alikes of the best, likeliest first
  std::vector<Rival> league;  ///< all rows, by gain
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

/// Whether two rows are of one alias class, which no data tell apart. The same law on the link and
/// on the motor is two.
bool same_class(const Refinement& a, const Refinement& b);

/// Squared residual over floor that a base of no fault reaches: floors are known to some per cent.
inline constexpr double kNoGap = 1.07;
/// Above this something is there that was not named.
inline constexpr double kRemainder = 1.2;
/// Gain on unseen rows, in its sd over the blocks, that an effect needs which leaves a remainder:
/// in what wanders the best of a search gains a little on other logs as often as not.
inline constexpr double kClearlyBetter = 2;
/// Squared gap over floor that is seen on unseen rows.
inline constexpr double kVisibleGap = 1.1;

/// What adding an effect did on logs that had no say.
struct UnseenChange {
  const Refinement& row;
  double rho_before = 0, rho_after = 0;  ///< equations
  const SimulatedGap &before, &after, &floor;
  bool leaves_remainder = false;  ///< of the training rows, above kRemainder
  double sd_better = kUnbounded;  ///< of its gain, blocks of unseen rows paired
};
/// Why it is refused, whatever it did to the equation error of the training logs; empty: it is
/// not. Events are judged on their own log.
std::string why_not_added(const UnseenChange& change);

/// The same of two effects at once, of which the first was refused alone. A pair of the catalogue
/// may mimic what is not in it, so both together have to leave nothing that is seen.
std::string why_not_both(const UnseenChange& change);

/// Verdict, reason and next experiment of a result whose effects stand.
void conclude(RefineResult& result);

/// Whether any candidate is worth the bootstrap at all.
bool anything_material(const std::vector<Candidate>& candidates, const RefineOptions& options);

}  // namespace cablefit
