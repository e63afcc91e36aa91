// When the descents of elongations and of radii end.
#pragma once

namespace cablefit {

inline constexpr int kMostDescents = 40;
inline constexpr double kDescentConverged = 1e-8;  ///< of the reach or the radius, far below any sd
inline constexpr double kSmallestDescent = 2e-3;   ///< of the Gauss-Newton step

}  // namespace cablefit
