// When the descents of elongations and of radii end.
#pragma once

namespace cablefit {

inline constexpr int kMaxIterations = 40;
inline constexpr double kConverged = 1e-8;     ///< of the reach or the radius, far below any sd
inline constexpr double kSmallestStep = 2e-3;  ///< of the Gauss-Newton step

}  // namespace cablefit
