// Stage 1 (Fichera & Grossard 2017, 4.1.1): the link is blocked and the motor moves slowly. Up to
// the motor's own friction, its torque is the elastic torque: tau = tau_elas(theta - q) + offset +-
// f_sm.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cablefit/elastic/elastic_result.hpp"

namespace cablefit {

/// Where tau_elas is zero. The paper knows the zero of the deflection, and the drive may have an
/// offset. A log with an arbitrary encoder zero has an unknown theta_0 instead. The two are
/// separable only when the curve has a kink.
enum class ZeroMode { automatic, offset, theta_0 };

/// Straight lines K (theta - N q) to compare with the fits, and logs to score both on (Figs. 6b and
/// 7b).
struct ComparedLines {
  std::vector<double> stiffnesses;                ///< K, N m/rad, given
  std::vector<std::pair<double, double>> ranges;  ///< K fitted to deflections from .. to, rad
  std::span<const LogSurvey> test = {};           ///< blocked logs that nothing was fitted to

  bool empty() const { return stiffnesses.empty() && ranges.empty() && test.empty(); }
};

struct ElasticOptions {
  SampleOptions samples;
  int order = 0;                 ///< of all cables; 0: those of `orders`, the rig file's, or chosen
  std::vector<int> orders = {};  ///< per cable, instead of `order`; empty: not given
  /// Choose the orders even where the rig file gives them: per cable the lowest by block
  /// cross-validation.
  bool choose_orders = false;
  int max_order = 6;  ///< of a choice
  double materiality =
      0.01;  ///< of the peak torque: a smaller difference on held-out blocks does not matter
  bool still = false;  ///< also use the parts of moving logs in which the link stands still
  ZeroMode zero = ZeroMode::automatic;
  /// --offset: offset of the drive, N m, given instead of fitted (0 with several joints). None:
  /// fitted.
  std::optional<double> offset = {};
  /// Allows a negative cable stiffness, as the paper's plain fit does, with a warning.
  bool unconstrained = false;
  bool robust_sd = true;     ///< --sd honest | white
  std::string preload;       ///< only this one; empty: all
  ComparedLines lines = {};  ///< straight lines to score beside the fits
  bool figures = false;      ///< one more pass, for reports with plots
  /// Given coefficients of all cables of one joint, one after the other. Then only offset and
  /// friction are fitted. None: fitted.
  std::vector<double> coefficients = {};
  bool bases = false;  ///< compare bases of the cables' force (cable_bases.hpp)
};

/// Fits every preload in the blocked logs (with `still`: in all logs). Throws Error(input) when
/// there is no blocked log, a channel is missing, or theta never moves. Throws
/// Error(not_identifiable) when the logs determine no parameter of any preload.
ElasticResult fit_elastic(std::span<const LogSurvey> logs, const ElasticOptions& options);

}  // namespace cablefit
