#include "cablefit/copies/surrogate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/copies/fast_motion.hpp"
#include "cablefit/model/joint_inertias.hpp"

namespace cablefit {
namespace {

constexpr double kBandwidth = 5;  // Hz: slower than most joint controllers, so that little of a
                                  // disturbance comes back that did not before
// Of a torque that is not held: commands in a row of the log, an even number, at least this often.
constexpr int kLeastCommands = 4;
constexpr double kCommandPeriod = 1e-3;  // s
constexpr double kSame = 0.95;           // of a row: a command that is held about as long as it

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

int commands_per_row(double period, bool torque_held) {
  if (torque_held) return 1;
  const int by_time = 2 * static_cast<int>(std::ceil(0.5 * period / kCommandPeriod));
  return std::max(kLeastCommands, by_time);
}

/// Columns with n - 1 rows more between neighbours, cubic (Catmull & Rom 1974): no corners.
Eigen::MatrixXd refined(const Eigen::MatrixXd& columns, int n) {
  if (n == 1) return columns;
  const Eigen::Index last = columns.rows() - 1;
  const auto row = [&](Eigen::Index i) {
    return columns.row(std::clamp<Eigen::Index>(i, 0, last));
  };
  Eigen::MatrixXd fine(last * n + 1, columns.cols());
  for (Eigen::Index i = 0; i < fine.rows(); ++i) {
    const Eigen::Index k = i / n;
    const double x = static_cast<double>(i % n) / n;
    const double before = 0.5 * x * (-1 + x * (2 - x)), here = 1 + 0.5 * x * x * (-5 + 3 * x);
    const double next = 0.5 * x * (1 + x * (4 - 3 * x)), after = 0.5 * x * x * (x - 1);
    fine.row(i) = before * row(k - 1) + here * row(k) + next * row(k + 1) + after * row(k + 2);
  }
  return fine;
}

void take_load(const LogPlan& plan, CopyStretch& stretch) {
  const int n_joints = plan.rig.n_joints();
  if (!plan.has_for_all(Channel::tau_load)) return;
  Eigen::MatrixXd load(stretch.measured.rows(), n_joints);
  for (int joint = 0; joint < n_joints; ++joint)
    load.col(joint) = stretch.measured.col(plan.find(Channel::tau_load, joint));
  stretch.input.tau_load = refined(load, stretch.fine).array();
}

void follow_measured(const Model& model, const LogPlan& plan, const CopyDrive& drive,
                     CopyStretch& stretch) {
  const bool is_held_shorter =
      drive.torque_held && drive.torque_period > 0 && drive.torque_period < kSame * stretch.period;
  stretch.fine = commands_per_row(stretch.period, drive.torque_held && !is_held_shorter);
  stretch.late = is_held_shorter ? 0.5 * drive.torque_period : 0;
  const double period = stretch.input.period = stretch.period / stretch.fine;
  const Controller controller =
      controller_by_inertias(model, stretch.link_blocked, [period](const JointInertias& inertias) {
        return pd_controller(inertias, kBandwidth, 1, period);
      });
  const int n_joints = plan.rig.n_joints();
  stretch.input.theta_ref.resize((stretch.measured.rows() - 1) * stretch.fine + 1, n_joints);
  for (int joint = 0; joint < n_joints; ++joint) {
    Eigen::MatrixXd both(stretch.measured.rows(), 2);
    both.col(0) = stretch.measured.col(plan.find(Channel::theta, joint));
    both.col(1) = stretch.measured.col(plan.find(Channel::tau, joint));
    both = smooth(both, stretch.period, drive.cutoff);
    if (drive.cutoff > 0) {
      const FastMotion fast = fast_motion(model, plan, stretch, joint,
                                          {drive.cutoff, drive.dither_cutoff}, drive.torque_held);
      both.col(0) += fast.theta;
      both.col(1) += fast.tau;
    }
    both = refined(both, stretch.fine);
    stretch.input.theta_ref.col(joint) =
        reference_for(both.col(0).array(), both.col(1).array(),
                      controller.of(static_cast<std::size_t>(joint)), period);
  }
  stretch.rig.controller = controller;
  stretch.rig.sensors.clear();  // it reads theta as it is; what is recorded is rounded all the same
}

/// A channel of every joint, as it was measured.
void take_inputs(const LogPlan& plan, Channel channel, const CopyStretch& stretch,
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

namespace {

std::string choose(const Model& model, const LogSurvey& log, const CopyDrive& drive,
                   CopyStretch& stretch) {
  const LogPlan& plan = log.plan;
  stretch.rig = plan.rig;
  if (plan.rig.open_loop) {
    take_inputs(plan, Channel::tau, stretch, stretch.input.tau);
    stretch.hold_torque = drive.torque_held;
    return "none: the measured torque is a command, by the rig file";
  }
  if (drive.follows || !has_reference(plan)) {
    follow_measured(model, plan, drive, stretch);
    return fmt::format(
        "a surrogate controller of {:g} Hz that follows the measured theta, the measured torque as "
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

}  // namespace

std::string choose_controller(const Model& model, const LogSurvey& log, const CopyDrive& drive,
                              CopyStretch& stretch) {
  std::string which = choose(model, log, drive, stretch);
  take_load(log.plan, stretch);
  return which;
}

}  // namespace cablefit
