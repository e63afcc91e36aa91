// How far the mean of a residual over a window of time is from zero: the noise of a detector that
// averages, for noise of any colour.
#pragma once

#include <span>

namespace cablefit {

struct WindowMean {
  double seconds = 0;  ///< length of the window
  double sd = 0;       ///< of the mean over it, in the residual's unit
};

/// sd for windows of that length: between two lengths linear in the logarithms, below the shortest
/// that of the shortest, beyond the longest as white noise would go on. `all`: ascending, not
/// empty.
double sd_of_mean(std::span<const WindowMean> all, double seconds);

}  // namespace cablefit
