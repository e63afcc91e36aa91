// The decision rule on what a search named: whether held-out data let it stay, and the
// verdict in the end. Internal to refine/.
#pragma once

#include <string>
#include <string_view>

#include "cablefit/refine/gap_levels.hpp"
#include "cablefit/refine/refine_result.hpp"
#include "cablefit/refine/verdict/confirm.hpp"

namespace cablefit {

/// Gain on held-out rows, in its sd over the blocks, of which these are sure.
inline constexpr double kClearlyBetter = 2;

/// What adding an effect did on data that it was not fitted to: held-out blocks, or test logs.
struct HeldOutChange {
  const Effect& row;
  double rho_before = 0, rho_after = 0;  ///< equations
  bool leaves_remainder = false;         ///< of the training rows, above kRemainder
  double sd_better = kUnbounded;         ///< of its gain, blocks paired
  bool is_after_event = false;           ///< rows that an event should show in
  double closed = 1;                     ///< share of the training rows' gap
  double chance_of_size = 0;  ///< P of coefficients as large where there is no such effect
  double gone = kUnbounded;   ///< of the training rows' rho
  std::string_view data = "held-out blocks";
};
/// Why it is refused, whatever it did to the equation error of the training rows; empty: it is
/// not. Events are judged by the equations of rows after them.
std::string why_not_added(const HeldOutChange& change);

/// The same of the last of two effects that were added together: `before` neither was there. A pair
/// may mimic what is not in it, so both together have to leave nothing that is seen.
std::string why_not_both(const HeldOutChange& change);

/// The same of simulations in closed loop; a replay of the measured torque drifts, whatever the
/// model, and refuses nothing.
std::string why_not_simulated(const SimulatedGap& before, const SimulatedGap& after,
                              const SimulatedGap& floor);

/// Squared gaps over their floor before and after all effects together: training rows, and rows
/// that were held out.
struct Gaps {
  double before = 0, after = 0, held_out_before = 0, held_out_after = 0;
  bool has_event = false;  ///< of which held-out rows may know nothing
};
/// Share of the squared gap above the floor that they close: of the held-out rows', where these
/// show one (shows_gap), else of the training rows'.
double closed_share(const Gaps& gaps);
bool shows_gap(const Gaps& gaps);
/// Least share of names. On another bench right ones closed .92 (median), wrong ones .19; half
/// keeps 101 of 111 right answers and drops 22 of 34 wrong ones.
inline constexpr double kLeastClosed = 0.5;

/// Verdict, reason and next experiment of a result whose effects stand.
void conclude(RefineResult& result);

}  // namespace cablefit
