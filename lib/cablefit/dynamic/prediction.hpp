// Expected uncertainty of the parameters of stage 2, from the motion and the sensors' noise,
// before stage 1 and any fit: which are separable, and how small their sd can be.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "cablefit/samples/check.hpp"

namespace cablefit {

/// weak: its sd is above 10 %, or its estimate correlates with another by more than 0.95.
/// not_identifiable: above 50 %, or refused as by a fit. 10 % of its size; of all torque where it
/// may well be 0, as an offset or a friction of less than 1 % of the torque.
enum class Determined { identifiable, weak, not_identifiable, given };
std::string_view to_string(Determined determined);

struct PredictedParameter {
  std::string name, unit;
  /// By a preliminary fit, a rough model of these logs alone: one digit of it may be right. NaN
  /// where it is not determined.
  double size = 0;
  double sd_best = 0;  ///< white, noise of the sensors only; infinite when not determined
  /// Robust, with the residual of the rough model, without the error of stage 1; NaN when not
  /// determined.
  double sd_first_look = 0;
  std::string closest = {};  ///< the parameter it correlates with most; empty: it is alone
  double correlation = 0;
  Determined determined = Determined::identifiable;

  /// sd_first_look (sd_best when there is none) of the size, NaN when that is not known.
  double relative_sd() const;
};

/// One equation, or the links of an arm, which share parameters.
struct PredictedEquation {
  std::string name;  ///< "link", "motor[2]", "rigid"
  std::size_t rows = 0;
  double condition_scaled = 0;
  double noise = 0;  ///< rms that the sensors' noise makes in the equation, at most `left`, N m
  double left = 0;   ///< rms of the rough model's residual, N m
  std::vector<PredictedParameter> parameters;
  /// Parameters that are not or weakly determined, and the motion that would determine them.
  std::vector<std::string> sentences;
};

/// The moving logs of one preload, which `cablefit dynamic` would fit together.
struct Prediction {
  std::string preload;
  std::vector<std::string> logs;  ///< paths
  bool rigid = false;
  bool linear_motion = false;
  double cutoff = 0;  ///< Hz
  std::vector<PredictedEquation> equations;
  std::string none;  ///< why there is no prediction; empty when there is one
};

/// Moving parts of `logs` by preload and rig, those of `checked` that stage 2 or a rigid drive can
/// be identified from. The rough model has the rig's cables (else an antagonist pair of order 2)
/// with coefficients from the motor equation.
std::vector<Prediction> predict_estimates(std::span<const LogSurvey> logs,
                                          const CheckResult& checked, const SampleOptions& options);

}  // namespace cablefit
