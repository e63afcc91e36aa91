// A straight line through estimates of several preloads, with its uncertainty.
#pragma once

#include <span>

namespace cablefit {

/// An estimate at one preload: y at x, with their joint variances; 0: exact, or not known.
struct PreloadEstimate {
  double x = 0, y = 0;
  double var_x = 0, var_y = 0, cov = 0;
};

/// y = middle_y + slope (x - middle_x). `misfit`: sd of what the variances do not explain, part of
/// every sd.
struct PreloadLine {
  double middle_x = 0, middle_y = 0, slope = 0;
  double var_middle = 0, var_slope = 0;  ///< uncorrelated; NaN: not known
  double misfit = 0;
  double p_value = 1;        ///< of the misfit under the null; 1 with two preloads
  double t_quantile = 0;     ///< of the 95 % interval
  double low = 0, high = 0;  ///< x that the line is used for: kBeyond of the range on either side

  double intercept() const { return middle_y - slope * middle_x; }
  double intercept_sd() const;
  double slope_sd() const;
  double value(double x) const { return middle_y + slope * (x - middle_x); }
  double sd(double x) const;
  bool holds(double x) const;
};

/// Of the range of the fitted preloads, on either side; never below 0.
inline constexpr double kBeyond = 0.2;

/// Weighted least squares, two or more estimates at two or more x. Variances: var_y - 2 slope cov +
/// slope^2 var_x (effective variance; Orear 1982). With three or more estimates a misfit beyond
/// these is one more variance, chosen so that chi-squared equals its degrees of freedom (Paule &
/// Mandel 1982); the t quantile has the degrees of freedom of the sum (Welch 1947). Two estimates
/// without variances give no sd.
PreloadLine fit_preload_line(std::span<const PreloadEstimate> estimates);

}  // namespace cablefit
