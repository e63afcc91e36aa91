// Colour of an equation's residual: its autocovariance over rows, and the spectrum of that.
// Internal to refine/.
#pragma once

#include "cablefit/copies/coloured_noise.hpp"
#include "cablefit/refine/rows/evidence.hpp"

namespace cablefit {

/// Autocovariance of an equation's residual, about zero, lags one row apart.
struct ResidualMemory {
  double period = 0;           ///< s, between rows; 0: there are none
  Eigen::VectorXd covariance;  ///< (N m)^2, lag 0, 1, ...
  std::size_t n_values = 0;
};
ResidualMemory residual_memory(const Design& design, const Eigen::VectorXd& x, RowKind kind,
                               std::size_t n_lags);

/// Power of a stationary series in bands of equal width from 0 Hz up to half its rate.
struct Spectrum {
  double width = 0;      ///< Hz, of a band
  Eigen::ArrayXd power;  ///< (N m)^2 per band; their sum is the variance
  double middle(Eigen::Index band) const { return (static_cast<double>(band) + 0.5) * width; }
};
/// Blackman & Tukey 1958: the cosine transform of the autocovariance under a Hann window. Holes in
/// the series do not bias it. `n_bands`: at most the number of lags.
Spectrum spectrum_of(const ResidualMemory& memory, Eigen::Index n_bands);

}  // namespace cablefit
