// What `cablefit dynamic` would tell of every parameter from a motion that is planned: the white sd
// that the sensors' noise leaves, through its own filters, decimation and rows.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cablefit/design/excited_motion.hpp"
#include "cablefit/samples/survey.hpp"

namespace cablefit {

struct PlannedParameter {
  std::string equation, name, unit;
  double value = 0;  ///< of the model
  double sd = 0;     ///< to expect; infinite when the motion does not show it
  /// sd over the size: the value, or what makes a hundredth of the joint's torque (rms) where that
  /// is more; of what may be of either sign, as an offset, what makes all of the torque.
  double relative = 0;
};

/// The log that a motion would leave, without noise: q, theta, tau, and tau_load where the rig has
/// no law of q. Its rig holds the torque over a row.
LogSurvey planned_log(const Model& model, const ExcitedMotion& motion);

/// Settings are chosen once, from a first motion, so that motions can be compared. Throws
/// Error(input) when the rig does not say how noisy its sensors are, and Error(not_identifiable)
/// for a motion too short or too slow to fit anything to.
class FitPlanner {
 public:
  FitPlanner(const Model& model, const ExcitedMotion& first);
  ~FitPlanner();
  FitPlanner(const FitPlanner&) = delete;
  FitPlanner& operator=(const FitPlanner&) = delete;

  /// On several threads at a time if need be.
  std::vector<PlannedParameter> parameters(const ExcitedMotion& motion) const;
  double cutoff() const;  ///< Hz

 private:
  struct Settings;
  std::unique_ptr<Settings> settings_;
};

/// The largest relative sd; infinite when some parameter is not shown.
double worst_relative_sd(const std::vector<PlannedParameter>& parameters);

}  // namespace cablefit
