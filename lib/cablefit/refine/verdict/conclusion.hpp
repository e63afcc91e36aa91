// The decision rule for an effect that a search found: whether held-out data confirm it, and the
// final verdict. Internal to refine/.
#pragma once

#include <string>
#include <string_view>

#include "cablefit/refine/gap_levels.hpp"
#include "cablefit/refine/refine_result.hpp"
#include "cablefit/refine/verdict/confirm.hpp"

namespace cablefit {

/// Gain on held-out rows, in its sd over the blocks, that counts as clear.
inline constexpr double kClearlyBetter = 2;

/// Change by an added effect on data that it was not fitted to: held-out blocks, or test logs.
struct HeldOutChange {
  const Effect& row;
  double rho_before = 0, rho_after = 0;  ///< of the equations
  bool leaves_remainder = false;         ///< of the training rows, above kRemainder
  double sd_better = kUnbounded;         ///< gain in its sd, blocks paired
  bool is_after_event = false;           ///< there are rows that should show the event
  double closed = 1;                     ///< explained share of the training rows' gap
  double chance_of_size = 0;             ///< P of coefficients this large without such an effect
  double gone = kUnbounded;              ///< decrease of the training rows' rho
  std::string_view data = "held-out blocks";
};
/// Why the effect is rejected, independent of its gain on the training rows; empty: it is accepted.
/// Events are judged by the equations of rows after them.
std::string why_not_added(const HeldOutChange& change);

/// As why_not_added(), for the last of two effects that were added together. `before`: without
/// either. A pair may imitate another effect, so both together must leave no visible residual.
std::string why_not_both(const HeldOutChange& change);

/// As why_not_added(), for simulations in closed loop. A replay of the measured torque drifts with
/// any model, so it rejects nothing.
std::string why_not_simulated(const SimulatedGap& before, const SimulatedGap& after,
                              const SimulatedGap& floor);

/// Squared gaps over their floor before and after all effects together: of training rows and of
/// held-out rows.
struct Gaps {
  double before = 0, after = 0, held_out_before = 0, held_out_after = 0;
  bool has_event = false;  ///< the held-out rows may not show it
};
/// Explained share of the squared gap above the floor: of the held-out rows' where these show one
/// (shows_gap), else of the training rows'.
double closed_share(const Gaps& gaps);
bool shows_gap(const Gaps& gaps);
/// Least explained share of an identified effect. On another bench right effects explain .92
/// (median), wrong ones .19. A limit of one half keeps 101 of 111 right answers and drops 22 of 34
/// wrong ones.
inline constexpr double kLeastClosed = 0.5;

/// `named`, or `ambiguous` where an effect has rivals. For a result with effects.
Verdict verdict_by_rivals(const RefineResult& result);

/// Sets verdict, reason and next experiment of a result with its final effects.
void conclude(RefineResult& result);

}  // namespace cablefit
