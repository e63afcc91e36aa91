// Expected uncertainty of the parameters of stage 2, from the motion and the sensors' noise, before
// stage 1 and any fit. It shows which parameters are separable and how small their sd can be.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "cablefit/base/axes.hpp"
#include "cablefit/samples/check.hpp"

namespace cablefit {

/// weak: the relative sd is above 10 %, or the estimate correlates with another by more than 0.95.
/// not_identifiable: above 50 %, or a fit would refuse it. The sd is relative to the parameter's
/// size. For an offset, or a friction of less than 1 % of the torque, it is relative to all torque:
/// such a parameter may well be 0.
enum class Determined { identifiable, weak, not_identifiable, given };
std::string_view to_string(Determined determined);

struct PredictedParameter {
  std::string name, unit;
  /// By a preliminary fit: a rough model of these logs alone, so at most one digit is right. NaN
  /// where it is not determined.
  double size = 0;
  double sd_best = 0;  ///< white, noise of the sensors only; infinite when not determined
  /// Robust sd: with the residual of the rough model, without the error of stage 1. NaN when not
  /// determined.
  double sd_first_look = 0;
  std::string closest = {};  ///< the parameter with the strongest correlation; empty: none
  double correlation = 0;
  Determined determined = Determined::identifiable;

  /// sd_first_look (else sd_best) over the size; NaN when the size is not known.
  double relative_sd() const;
};

/// One equation, or the links of an arm, which share parameters.
struct PredictedEquation {
  std::string name;  ///< "link", "motor[2]", "rigid"
  std::size_t rows = 0;
  double condition_scaled = 0;
  double noise = 0;  ///< rms of the sensors' noise in the equation, at most `left`, N m
  double left = 0;   ///< rms of the rough model's residual, N m
  std::vector<PredictedParameter> parameters;
  /// Parameters that are weakly or not determined, and the motion that would determine them.
  std::vector<std::string> sentences;
};

/// The moving logs of one preload, which `cablefit dynamic` would fit together.
struct Prediction {
  std::string preload;
  std::vector<std::string> logs;  ///< paths
  bool rigid = false;
  Axes axes = Axes::rotary;
  double cutoff = 0;  ///< Hz
  std::vector<PredictedEquation> equations;
  std::string none;  ///< why there is no prediction; empty when there is one
};

/// Moving parts of `logs` by preload and rig: those of `checked` that stage 2 or a rigid drive can
/// be identified from. The rough model has the rig's cables, else an antagonist pair of order 2.
/// Their coefficients come from the motor equation.
std::vector<Prediction> predict_estimates(std::span<const LogSurvey> logs,
                                          const CheckResult& checked, const SampleOptions& options);

}  // namespace cablefit
