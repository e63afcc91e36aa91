#include "cablefit/prove/stand_in.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "cablefit/model/least_inertias.hpp"
#include "cablefit/samples/butterworth.hpp"

namespace cablefit {
namespace {

constexpr double kBandwidth = 5;      // Hz: slower than most joint controllers, so that little of a
                                      // disturbance comes back that did not before
constexpr double kLargestGain = 0.3;  // kd period / J_motor; a sampled loop is unstable at 2
constexpr int kCommandsPerRow = 8;    // of a torque that is not held
constexpr double kWidestBand = 0.4;   // of the rate, for the low-pass
constexpr int kFilterOrder = 4;

/// A PD controller of kBandwidth, as damped as the motor's inertia allows.
Controller stand_in(const LeastInertias& inertias, double period) {
  const double omega = 2 * std::numbers::pi * kBandwidth;
  Controller controller;
  controller.kd = std::min(2 * inertias.all * omega, kLargestGain * inertias.motor / period);
  controller.kp = controller.kd * omega / 2;
  controller.period = period;
  return controller;
}

Eigen::MatrixXd smooth(const Eigen::MatrixXd& columns, double period, double cutoff) {
  Eigen::MatrixXd out = columns;
  if (cutoff > 0 && cutoff < kWidestBand / period)
    Butterworth(kFilterOrder, cutoff, 1 / period).apply(out, true, true);
  return out;
}

/// theta_ref with which the controller's torque at theta is exactly tau: theta + e, where
/// kp e_i + kd (e_i - e_(i-1)) / period = tau_i.
Eigen::ArrayXd reference_for(const Eigen::ArrayXd& theta, const Eigen::ArrayXd& tau,
                             const Controller& controller, double period) {
  const double kd = controller.kd / period;
  Eigen::ArrayXd reference = theta;
  double error = tau.size() > 0 ? tau(0) / controller.kp : 0;
  for (Eigen::Index i = 0; i < tau.size(); ++i) {
    error = (tau(i) + kd * error) / (controller.kp + kd);
    reference(i) += error;
  }
  return reference;
}

void follow_measured(const Model& model, const LogPlan& plan, const TwinDrive& drive,
                     TwinStretch& stretch) {
  const double period = stretch.input.period;
  const Controller controller = stand_in(least_inertias(model, stretch.link_blocked),
                                         drive.torque_held ? period : period / kCommandsPerRow);
  const int n_joints = plan.rig.n_joints();
  stretch.input.theta_ref.resize(stretch.measured.rows(), n_joints);
  for (int joint = 0; joint < n_joints; ++joint) {
    Eigen::MatrixXd both(stretch.measured.rows(), 2);
    both.col(0) = stretch.measured.col(plan.find(Channel::theta, joint));
    both.col(1) = stretch.measured.col(plan.find(Channel::tau, joint));
    both = smooth(both, period, drive.cutoff);
    stretch.input.theta_ref.col(joint) =
        reference_for(both.col(0).array(), both.col(1).array(), controller, period);
  }
  stretch.rig.controller = controller;
  stretch.rig.sensors.clear();  // it reads theta as it is; what is recorded is rounded all the same
}

/// A channel of every joint, as it was measured.
void take_inputs(const LogPlan& plan, Channel channel, const TwinStretch& stretch,
                 Eigen::ArrayXXd& inputs) {
  inputs.resize(stretch.measured.rows(), plan.rig.n_joints());
  for (int joint = 0; joint < plan.rig.n_joints(); ++joint)
    inputs.col(joint) = stretch.measured.col(plan.find(channel, joint)).array();
}

}  // namespace

bool has_reference(const LogPlan& plan) {
  for (int joint = 0; joint < plan.rig.n_joints(); ++joint)
    if (!plan.has(Channel::theta_ref, joint)) return false;
  return plan.rig.controller.has_value();
}

std::string choose_controller(const Model& model, const LogSurvey& log, const TwinDrive& drive,
                              TwinStretch& stretch) {
  const LogPlan& plan = log.plan;
  stretch.rig = plan.rig;
  if (plan.rig.open_loop) {
    take_inputs(plan, Channel::tau, stretch, stretch.input.tau);
    stretch.hold_torque = drive.torque_held;
    return "none: the measured torque, which the rig file says is a command";
  }
  if (drive.follows || !has_reference(plan)) {
    follow_measured(model, plan, drive, stretch);
    return fmt::format(
        "a stand-in of {:g} Hz that follows the measured theta, the measured torque as "
        "feed-forward",
        kBandwidth);
  }
  const int n_joints = plan.rig.n_joints();
  take_inputs(plan, Channel::theta_ref, stretch, stretch.input.theta_ref);
  for (int joint = 0; joint < n_joints; ++joint) {
    const auto theta = static_cast<std::size_t>(plan.find(Channel::theta, joint));
    SensorInfo& sensor =
        stretch.rig
            .sensors[n_joints > 1 ? fmt::format("theta{}", joint + 1) : std::string("theta")];
    if (!sensor.quantum) sensor.quantum = log.parts[stretch.part].channels[theta].quantum;
  }
  return "the rig's, with the reference of the log";
}

}  // namespace cablefit
