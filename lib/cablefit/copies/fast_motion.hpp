// The fast part of a measured torque that moved the motor, and that motion. A surrogate controller
// must pass it. Internal to copies/.
#pragma once

#include "cablefit/copies/simulated_copy.hpp"

namespace cablefit {

/// Columns after a zero-phase low-pass (Hz); unchanged where it is 0 or above half the rate.
Eigen::MatrixXd smooth(const Eigen::MatrixXd& columns, double period, double cutoff);

struct FrequencyBand {
  double from = 0, to = 0;  ///< Hz
};

/// Of one joint, n rows each.
struct FastMotion {
  Eigen::VectorXd theta, tau;  ///< rad; N m
};

/// The part of a band of the measured torque that acted. The torque that the model's motion
/// requires acted; noise of a torque sensor did not. `joint`: from 0.
FastMotion fast_motion(const Model& model, const LogPlan& plan, const CopyStretch& stretch,
                       int joint, const FrequencyBand& band, bool torque_held);

}  // namespace cablefit
