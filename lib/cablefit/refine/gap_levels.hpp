// Is there a gap? All thresholds for the squared residual over the squared noise floor, each with
// its reason. Internal to refine/.
#pragma once

namespace cablefit {

/// Above this the simulated data get a disturbance: floors are known to some per cent.
inline constexpr double kDisturbed = 1.05;
/// A model that lacks no effect may reach this.
inline constexpr double kNoGap = 1.07;
/// Above this there is a gap on held-out samples, and in a band, a regime or a log, whose floors
/// are less well known.
inline constexpr double kVisibleGap = 1.1;
/// Above this an effect remains that was not identified.
inline constexpr double kRemainder = 1.2;

/// Of the squared gap: a band or a regime with less of it is not told.
inline constexpr double kToldShare = 0.1;

}  // namespace cablefit
