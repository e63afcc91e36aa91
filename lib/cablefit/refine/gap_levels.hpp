// Is there a gap? Every level of the squared residual over the squared noise floor that decides
// something, with its reason. Internal to refine/.
#pragma once

namespace cablefit {

/// Above this a disturbance is put into the simulated data: floors are known to some per cent.
inline constexpr double kDisturbed = 1.05;
/// A model that lacks nothing may reach this.
inline constexpr double kNoGap = 1.07;
/// A gap is seen above this on samples that were not fitted, and in a band, a regime or a log,
/// whose floors are less well known.
inline constexpr double kVisibleGap = 1.1;
/// Above this something is there that was not named.
inline constexpr double kRemainder = 1.2;

}  // namespace cablefit
