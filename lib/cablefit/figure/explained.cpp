#include "cablefit/figure/explained.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace cablefit {

std::string explained_percent(double squares, double residual_squares) {
  if (!(squares > 0) || !std::isfinite(residual_squares)) return "-";
  const double rest = 100 * residual_squares / squares;
  constexpr double kNothing = 5e-5;  // less is rounded away
  if (rest >= 100) return "0 %";
  if (rest < kNothing) return "100 %";
  // Two digits of the rest: 99.983 says more than 100.0.
  constexpr double kMostDecimals = 4;
  const double decimals = 1 - std::floor(std::log10(rest));
  return fmt::format("{:.{}f} %", 100 - rest,
                     static_cast<int>(std::clamp(decimals, 0.0, kMostDecimals)));
}

std::string Explained::about_mean() const {
  const double mean_squares = n_ > 0 ? sum_ * sum_ / static_cast<double>(n_) : 0;
  return explained_percent(squares_ - mean_squares, residual_squares_);
}

}  // namespace cablefit
