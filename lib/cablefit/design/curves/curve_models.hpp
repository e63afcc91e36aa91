// Simpler models of a joint's elastic torque, and how wrong they are: the classical linear spring
// (2), (29), and cables of a lower order with the true l_o, piecewise linear for order 1 (Fichera &
// Grossard 2017, Figs. 4 and 7, (30)).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "cablefit/design/curves/joint_curve.hpp"

namespace cablefit {

/// Deflections that a joint works in, rad (m): those of the torques -T .. T.
struct WorkingRange {
  double low = 0, high = 0;
};
/// Throws Error(input) when the cables never give this torque.
WorkingRange working_range(const JointCurve& curve, double torque);

/// Least squares over the range, every deflection alike (the integral, not a sum: exact for
/// polynomial cables).
struct CurveModel {
  std::string name;                  ///< "linear", "piecewise linear", "order 3", "cables"
  std::vector<double> coefficients;  ///< K; or per cable those of its order
  Transmission transmission;         ///< with these
  int joint = 0;                     ///< whose curve it is
  double max_error = 0;              ///< N m (N), largest |model - cables| on the range
  double rms_error = 0;              ///< N m (N)
  double at = 0;                     ///< deflection of the largest error
  double static_error = 0;           ///< rad (m), largest error of the deflection for a torque

  double torque(double phi) const;     ///< at a deflection
  double stiffness(double phi) const;  ///< its slope
};

/// tau = K phi.
CurveModel linear_spring(const JointCurve& curve, const WorkingRange& range);
/// Each cable a polynomial of this order (order 1: piecewise linear) with its own l_o, that only
/// pulls where it is taut. A cable that is never taut on the range has coefficients 0.
CurveModel cables_of_order(const JointCurve& curve, const WorkingRange& range, int order);
/// The linear spring, then cables of each of these orders.
std::vector<CurveModel> simpler_models(const JointCurve& curve, const WorkingRange& range,
                                       std::span<const int> orders);
/// The cables as they are: no error.
CurveModel cables_themselves(const JointCurve& curve);

}  // namespace cablefit
