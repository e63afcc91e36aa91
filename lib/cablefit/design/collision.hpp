// Smallest collision torque that a model's residual can detect.
//
// The detector averages the residual of the link's equation over windows of n = rate * window rows,
// one after the other. The residual is r = J_link qdd + friction - tau_elas(phi) - tau_load; with a
// perfect model and perfect sensors it is minus the contact's torque. A window with |mean r| above
// a threshold is a collision (generalised momentum and direct residuals: De Luca & Mattone 2003,
// Haddadin, De Luca & Albu-Schaeffer 2017; window and threshold: likelihood ratio of a mean, Kay
// 1998, ch. 3).
//
// The mean has three parts. The first is noise, with sd s over the window as it was measured. White
// noise with sd `noise` from row to row has s = noise / sqrt(n). Slow noise hardly averages: 7 % of
// the variance over 0.2 s turned one alarm an hour into 2150. The second is the model's error, of
// which only a bound is known, |e| <= model_error. The third is the contact's torque, of either
// sign, constant over at least one whole window. Rates are guaranteed for the worst e within its
// bound: e = +-model_error against false alarms, and against the contact for detection.
#pragma once

#include <optional>

namespace cablefit {

struct CollisionDetector {
  double noise = 0;                       ///< N m, sd of the residual from row to row, white
  double rate = 1000;                     ///< Hz, rows
  double window = 0.05;                   ///< s
  std::optional<double> mean_noise = {};  ///< N m, sd of the residual's mean over the window
  double model_error = 0;                 ///< N m, bound of |model - truth|
  double false_alarm_rate = 0;            ///< of windows without contact, above 0 and below 1
  double detection_rate = 0.99;  ///< of windows in contact, above false_alarm_rate and below 1
};

struct CollisionThreshold {
  int n_rows = 1;         ///< that are averaged, at least 1
  double mean_noise = 0;  ///< N m, sd of the mean
  double threshold = 0;   ///< N m, of |mean r|
  double torque = 0;      ///< N m, smallest contact that is detected at the detection rate
  double delay = 0;       ///< s, after which it is at the latest: two windows
};

/// Exact for Gaussian noise (to 1e-12 of the noise). About 2 model_error + (z_fa + z_d) s, where
/// z_fa is the normal quantile of 1 - false_alarm_rate (of 1 - false_alarm_rate / 2 without model
/// error) and z_d that of the detection rate.
CollisionThreshold collision_threshold(const CollisionDetector& detector);

/// Rate of windows that makes so many false alarms an hour.
double false_alarm_rate_of(double alarms_per_hour, double window);

/// P(|e + s g| > threshold) of a standard normal g.
double exceedance(double e, double s, double threshold);

}  // namespace cablefit
