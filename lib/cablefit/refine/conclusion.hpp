// The decision rule on what a search named: whether logs that had no say let it stay, and the
// verdict in the end. Internal to refine/.
#pragma once

#include <string>

#include "cablefit/refine/confirm.hpp"
#include "cablefit/refine/refine_result.hpp"

namespace cablefit {

/// Squared residual over floor that a base of no fault reaches: floors are known to some per cent.
inline constexpr double kNoGap = 1.07;
/// Above this something is there that was not named.
inline constexpr double kRemainder = 1.2;
/// Gain on unseen rows, in its sd over the blocks, of which these are sure.
inline constexpr double kClearlyBetter = 2;
/// Squared gap over floor that is seen on unseen rows.
inline constexpr double kVisibleGap = 1.1;

/// What adding an effect did on logs that had no say.
struct UnseenChange {
  const Refinement& row;
  double rho_before = 0, rho_after = 0;  ///< equations of the unseen rows
  const SimulatedGap &before, &after, &floor;
  bool leaves_remainder = false;  ///< of the training rows, above kRemainder
  double sd_better = kUnbounded;  ///< of its gain, blocks of unseen rows paired
  bool is_after_event = false;    ///< unseen rows that an event should show in
  double closed = 1;              ///< share of the training rows' gap
  double chance_of_size = 0;      ///< P of coefficients as large where there is no such effect
};
/// Why it is refused, whatever it did to the equation error of the training logs; empty: it is
/// not. Events are judged by the equations of rows after them.
std::string why_not_added(const UnseenChange& change);

/// The same of two effects at once, of which the first was refused alone. A pair of the catalogue
/// may mimic what is not in it, so both together have to leave nothing that is seen.
std::string why_not_both(const UnseenChange& change);

/// Verdict, reason and next experiment of a result whose effects stand.
void conclude(RefineResult& result);

}  // namespace cablefit
