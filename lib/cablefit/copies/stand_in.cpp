#include "cablefit/copies/stand_in.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cablefit/model/least_inertias.hpp"
#include "cablefit/samples/butterworth.hpp"
#include "cablefit/simulate/coupling.hpp"

namespace cablefit {
namespace {

constexpr double kBandwidth = 5;      // Hz: slower than most joint controllers, so that little of a
                                      // disturbance comes back that did not before
constexpr double kLargestGain = 0.3;  // kd period / J_motor; a sampled loop is unstable at 2
// Of a torque that is not held: commands in a row of the log, an even number, at least this often.
constexpr int kLeastCommands = 4;
constexpr double kCommandPeriod = 1e-3;  // s
constexpr double kWidestBand = 0.4;      // of the rate, for the low-pass
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

void take_load(const LogPlan& plan, TwinStretch& stretch) {
  const int n_joints = plan.rig.n_joints();
  if (!plan.has_for_all(Channel::tau_load)) return;
  Eigen::MatrixXd load(stretch.measured.rows(), n_joints);
  for (int joint = 0; joint < n_joints; ++joint)
    load.col(joint) = stretch.measured.col(plan.find(Channel::tau_load, joint));
  stretch.input.tau_load = refined(load, stretch.fine).array();
}

Eigen::ArrayXd acceleration(const Eigen::ArrayXd& x, double period) {
  Eigen::ArrayXd out = Eigen::ArrayXd::Zero(x.size());
  const Eigen::Index n = x.size() - 2;
  if (n > 0) out.segment(1, n) = (x.head(n) - 2 * x.segment(1, n) + x.tail(n)) / (period * period);
  return out;
}

/// What the cables of one joint do on its motor where they were measured.
Eigen::VectorXd elastic_torque(const Model& model, const LogPlan& plan,
                               const Eigen::MatrixXd& measured) {
  Eigen::VectorXd torque = Eigen::VectorXd::Zero(measured.rows());
  if (model.rigid) return torque;
  const Coupling coupling(model.transmission);
  const int q = plan.find(Channel::q, 0), theta = plan.find(Channel::theta, 0);
  for (Eigen::Index i = 0; i < torque.size(); ++i) {
    double on_link = 0;
    coupling.torques(&measured(i, q), &measured(i, theta), &on_link, &torque(i));
  }
  return torque;
}

/// Share of the torque's variance that the model's motion asks for: what acted moved the motor,
/// what its sensor added did not. Columns: theta, tau, elastic torque.
/// An acceleration by differences is that of the middle between two torques that are held.
double share_that_acts(const Eigen::MatrixXd& band, double period, double inertia, bool is_held) {
  Eigen::VectorXd acted = band.col(1);
  const Eigen::Index n = acted.size() - 1;
  if (is_held && n > 0) acted.tail(n) = 0.5 * (band.col(1).head(n) + band.col(1).tail(n));
  const double all = acted.squaredNorm();
  if (!(all > 0)) return 0;
  const Eigen::VectorXd asked =
      inertia * acceleration(band.col(0).array(), period).matrix() + band.col(2);
  return std::clamp(asked.dot(acted) / all, 0.0, 1.0);
}

/// What of the torque of a single joint acted faster than the feed-forward's cut-off.
Eigen::VectorXd fast_torque(const Model& model, const LogPlan& plan, const TwinDrive& drive,
                            const TwinStretch& stretch) {
  const bool is_wanted = drive.cutoff > 0 && drive.dither_cutoff > drive.cutoff;
  if (!is_wanted || plan.rig.n_joints() > 1) return Eigen::VectorXd::Zero(stretch.measured.rows());
  Eigen::MatrixXd columns(stretch.measured.rows(), 3);
  columns << stretch.measured.col(plan.find(Channel::theta, 0)),
      stretch.measured.col(plan.find(Channel::tau, 0)),
      elastic_torque(model, plan, stretch.measured);
  const Eigen::MatrixXd band = smooth(columns, stretch.period, drive.dither_cutoff) -
                               smooth(columns, stretch.period, drive.cutoff);
  const double inertia = least_inertias(model, stretch.link_blocked).motor;
  return std::sqrt(share_that_acts(band, stretch.period, inertia, drive.torque_held)) * band.col(1);
}

void follow_measured(const Model& model, const LogPlan& plan, const TwinDrive& drive,
                     TwinStretch& stretch) {
  stretch.fine = commands_per_row(stretch.period, drive.torque_held);
  const double period = stretch.input.period = stretch.period / stretch.fine;
  const Controller controller = stand_in(least_inertias(model, stretch.link_blocked), period);
  const int n_joints = plan.rig.n_joints();
  stretch.input.theta_ref.resize((stretch.measured.rows() - 1) * stretch.fine + 1, n_joints);
  for (int joint = 0; joint < n_joints; ++joint) {
    Eigen::MatrixXd both(stretch.measured.rows(), 2);
    both.col(0) = stretch.measured.col(plan.find(Channel::theta, joint));
    both.col(1) = stretch.measured.col(plan.find(Channel::tau, joint));
    both = smooth(both, stretch.period, drive.cutoff);
    both.col(1) += fast_torque(model, plan, drive, stretch);
    both = refined(both, stretch.fine);
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

namespace {

std::string choose(const Model& model, const LogSurvey& log, const TwinDrive& drive,
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

std::string choose_controller(const Model& model, const LogSurvey& log, const TwinDrive& drive,
                              TwinStretch& stretch) {
  std::string which = choose(model, log, drive, stretch);
  take_load(log.plan, stretch);
  return which;
}

}  // namespace cablefit
