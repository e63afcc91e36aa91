// What each preload of a campaign buys and costs, from what was fitted: the trade-off on which
// Fichera & Grossard (2017, section 6) end.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "cablefit/campaign/batch.hpp"

namespace cablefit {

/// How a collision is looked for, see design/collision.hpp. A residual's mean over a window is
/// given no credit for averaging: filtered residuals hang together.
struct AdviceDetector {
  double window = 0.05;  ///< s
  double false_alarms_per_hour = 1;
  double detection_rate = 0.99;
};

/// One cell with both stages of a single joint. N m and rad; N and m on a linear axis. NaN: not
/// known.
struct PreloadAdvice {
  std::string cell;
  double deflection_low = 0, deflection_high = 0;  ///< range that the rest holds on
  double linear_error = 0;                         ///< largest of the linear spring, blocked
  double linear_share = 0;                         ///< of the peak torque, 0..1
  std::string model;                               ///< stage 1's choice
  double model_error = 0;                          ///< its largest error
  double friction = 0, friction_sd = 0;            ///< f_s + f_sm
  /// Deflections between which all cables are taut; NaN without an initial elongation.
  double closure_low = std::numeric_limits<double>::quiet_NaN();
  double closure_high = std::numeric_limits<double>::quiet_NaN();
  double collision_linear = 0, collision_model = 0;  ///< smallest contact torque that is detected
};

/// In the order of the cells; those without both stages, or with several joints, are left out.
std::vector<PreloadAdvice> preload_advice(const std::vector<BatchCell>& cells,
                                          const AdviceDetector& detector);

}  // namespace cablefit
