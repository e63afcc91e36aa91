// Bases for the force of a cable against its elongation, as dictionaries of atoms. Every atom is 0
// at l = 0: a cable without elongation has no force. To add one: a function and a line of the
// table.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace cablefit {

struct BasisAtom {
  std::string name;                            ///< "l^2", "Mexican hat about 5.5 mrad, ..."
  std::function<double(double)> force, slope;  ///< at l >= 0, and its derivative
};

/// A dictionary.
struct CableBasis {
  std::string_view name;
  std::string_view atoms_are;
  std::string_view source;
  bool monotone = false;  ///< atoms never fall: with coefficients >= 0 neither does the force
  bool ordered = false;   ///< terms are taken in their order, not by choice: powers
  /// For elongations from 0 to `longest`, m (rad in joint space). `unit`: of a thousandth of it.
  std::vector<BasisAtom> (*atoms)(double longest, std::string_view unit);
};

std::span<const CableBasis> cable_bases();

/// Cubic B-spline with the knots -2, -1, 0, 1, 2 (de Boor 1978, ch. X; Schoenberg 1946), and its
/// derivative and integral from -infinity.
double cubic_b_spline(double u);
double cubic_b_spline_slope(double u);
/// Mexican hat, (1 - u^2) exp(-u^2/2): minus the second derivative of a Gaussian, not normalised
/// (Daubechies 1992, 3.3.5).
double mexican_hat(double u);
double mexican_hat_slope(double u);
/// Splines with one knot, at u = 1, that never fall and are 0 at u = 0: (u - 1)+, (u - 1)+^2,
/// min(u, 1) and 1 - (1 - u)+^2. Their slopes are step and ramp above the knot, and below it: the
/// M-splines of order 1 and 2 on the knots 0, 1 and the end, whose integrals are I-splines (Ramsay
/// 1988).
double bent(double u);
double bent_slope(double u);
double curved(double u);
double curved_slope(double u);
double bent_below(double u);
double bent_below_slope(double u);
double curved_below(double u);
double curved_below_slope(double u);

}  // namespace cablefit
