// Sd of the mean of a residual over a window of time. It is the noise of a detector that averages,
// and holds for noise of any colour.
#pragma once

#include <span>

namespace cablefit {

struct WindowMean {
  double seconds = 0;  ///< length of the window
  double sd = 0;       ///< of the mean over it, in the residual's unit
};

/// The sd for windows of that length. Between two lengths it is linear in the logarithms. Below the
/// shortest length it is constant; above the longest it falls as for white noise. `all`: ascending,
/// not empty.
double sd_of_mean(std::span<const WindowMean> all, double seconds);

}  // namespace cablefit
