// Which fast part of a measured torque moved the motor, and that motion: what a surrogate
// controller has to let through. Internal to copies/.
#pragma once

#include "cablefit/copies/simulated_copy.hpp"

namespace cablefit {

/// Columns through a zero-phase low-pass (Hz); as they are where it is 0 or beyond the rate.
Eigen::MatrixXd smooth(const Eigen::MatrixXd& columns, double period, double cutoff);

struct FrequencyBand {
  double from = 0, to = 0;  ///< Hz
};

/// Of one joint, n rows each.
struct FastMotion {
  Eigen::VectorXd theta, tau;  ///< rad; N m
};

/// What a band of the measured torque did, as far as it acted: what moved the motor is what the
/// model's motion asks for, what a torque sensor adds is not.
/// `joint`: from 0.
FastMotion fast_motion(const Model& model, const LogPlan& plan, const CopyStretch& stretch,
                       int joint, const FrequencyBand& band, bool torque_held);

}  // namespace cablefit
