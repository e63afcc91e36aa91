#include "cablefit/design/excitation/excited_motion.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "cablefit/base/error.hpp"
#include "cablefit/design/curves/joint_curve.hpp"
#include "cablefit/model/arm/arm_dynamics.hpp"
#include "cablefit/model/joint_inertias.hpp"

namespace cablefit {
namespace {

constexpr int kTries = 5;         // of a scale
constexpr double kSettling = 2;   // s
constexpr double kMargin = 0.99;  // of the limit that was broken, at the next try
constexpr double kDamping = 0.7;
constexpr double kSurrogateBandwidth = 15;  // Hz

/// "kp 1.2, kd 0.03", of several joints "kp 1.2, 0.7, kd 0.03, 0.02".
std::string gains_text(const Controller& controller, std::size_t n_joints) {
  std::vector<double> kp, kd;
  for (std::size_t k = 0; k < n_joints; ++k) {
    kp.push_back(controller.of(k).kp);
    kd.push_back(controller.of(k).kd);
  }
  return fmt::format("kp {:.3g}, kd {:.3g}", fmt::join(kp, ", "), fmt::join(kd, ", "));
}

double load_on(const Model& model, const ExcitationLimits& limits, double q) {
  const Load& load = model.rig.load;
  const bool by_law = load.law != nullptr && !load.law->from_column;
  return by_law ? load.law->torque(load.parameters, q) : limits.load;
}

SimulationOptions in_closed_loop(double step) {
  SimulationOptions options;
  options.closed_loop = true;
  options.step = step;
  return options;
}

/// What holds each link there: against its load and the weight of an arm.
Eigen::VectorXd held_torques(const Model& model, const ExcitationLimits& limits) {
  const std::size_t n = model.joints.size();
  Eigen::VectorXd held = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(n),
                                                   -load_on(model, limits, limits.middle));
  if (!model.is_coupled()) return held;
  const std::vector<double> q(n, limits.middle), still(n, 0.0);
  ArmDynamics arm = arm_dynamics(model.rig.arm, model.arm);
  arm.evaluate(q.data(), still.data());
  return held + Eigen::Map<const Eigen::VectorXd>(arm.bias(), held.size());
}

/// Where each joint would rest if no cable coupled it with another.
SimulationInput resting_alone(const Model& model, const ExcitationLimits& limits) {
  const auto n = static_cast<Eigen::Index>(model.joints.size());
  SimulationInput input;
  input.period = 1 / limits.rate;
  input.q0 = input.qd0 = input.theta0 = input.thetad0 = Eigen::VectorXd::Zero(n);
  const Eigen::VectorXd zero =
      model.rigid ? Eigen::VectorXd(Eigen::VectorXd::Zero(n)) : model.transmission.encoder_zero();
  const Eigen::VectorXd held = held_torques(model, limits);
  for (Eigen::Index k = 0; k < n; ++k) {
    const double droop = held(k) / model.rig.controller->of(static_cast<std::size_t>(k)).kp;
    const double phi = model.rigid ? 0
                                   : JointCurve(model.transmission, static_cast<int>(k))
                                         .deflection_at(held(k))
                                         .value_or(0);
    input.theta0(k) = limits.middle - droop;
    input.q0(k) = limits.middle - droop - phi - zero(k);
  }
  return input;
}

void set_shares(const ExcitationLimits& limits, ExcitedMotion& motion) {
  const SimulationResult& r = motion.result;
  const auto largest = [](const Eigen::ArrayXXd& x) { return x.abs().maxCoeff(); };
  motion.position_share = std::max({largest(r.theta - limits.middle), largest(r.q - limits.middle),
                                    largest(motion.theta_ref - limits.middle)}) /
                          limits.max_position;
  motion.speed_share = std::max(largest(r.thetad), largest(r.qd)) / limits.max_speed;
  motion.torque_share = largest(r.tau) / limits.max_torque;
}

/// The factor at which the reference itself reaches its share of the limits.
double reference_scale(const ExcitationLimits& limits, const Eigen::ArrayXXd& shape, double share) {
  const Eigen::Index n = shape.rows();
  if (n < 2) return 0;
  const double way = shape.abs().maxCoeff();
  const double speed =
      (shape.bottomRows(n - 1) - shape.topRows(n - 1)).abs().maxCoeff() * limits.rate;
  if (!(way > 0 && speed > 0)) return 0;
  return share * std::min(limits.max_position / way, limits.max_speed / speed);
}

}  // namespace

Model excitable(const Model& model, double rate, std::string& words) {
  if (model.joints.empty())
    throw Error(ErrorKind::input,
                "a rig file has no inertias: an excitation needs a model file or a result of "
                "'cablefit dynamic', or CAD values in a model file");
  Model moved = model;
  if (moved.rig.controller) {
    words = "the rig's controller";
    return moved;
  }
  moved.rig.controller =
      controller_by_inertias(model, false, [rate](const JointInertias& inertias) {
        return pd_controller(inertias, kSurrogateBandwidth, kDamping, 1 / rate);
      });
  words = fmt::format("a surrogate controller ({}), as the rig has no controller",
                      gains_text(*moved.rig.controller, model.joints.size()));
  return moved;
}

SimulationInput at_rest(const Model& model, const ExcitationLimits& limits, double step) {
  SimulationInput start = resting_alone(model, limits);
  const auto n = static_cast<Eigen::Index>(model.joints.size());
  if (n == 1) return start;
  SimulationInput held = start;
  const auto rows = static_cast<Eigen::Index>(kSettling * limits.rate);
  held.theta_ref = Eigen::ArrayXXd::Constant(rows, n, limits.middle);
  held.tau_load = Eigen::ArrayXXd::Constant(rows, n, load_on(model, limits, limits.middle));
  Model settled = model;
  settled.rig.controller->ki = 0;  // a motion begins with an empty integral
  for (Controller& joint : settled.rig.controller->joints) joint.ki = 0;
  const SimulationResult end = simulate(settled, held, in_closed_loop(step));
  if (end.diverged_at) return start;  // and so will every motion
  start.q0 = end.q.bottomRows(1).transpose();
  start.qd0 = end.qd.bottomRows(1).transpose();
  start.theta0 = end.theta.bottomRows(1).transpose();
  start.thetad0 = end.thetad.bottomRows(1).transpose();
  return start;
}

std::optional<ExcitedMotion> motion_within(const Model& model, const ExcitationLimits& limits,
                                           const SimulationInput& start,
                                           const Eigen::ArrayXXd& shape, double share,
                                           double step) {
  ExcitedMotion motion;
  motion.period = 1 / limits.rate;
  motion.input = start;
  motion.input.tau_load =
      Eigen::ArrayXXd::Constant(shape.rows(), shape.cols(), load_on(model, limits, limits.middle));
  double scale = reference_scale(limits, shape, share);
  for (int i = 0; i < kTries && scale > 0; ++i) {
    motion.theta_ref = motion.input.theta_ref = limits.middle + scale * shape;
    motion.result = simulate(model, motion.input, in_closed_loop(step));
    if (motion.result.diverged_at) return std::nullopt;
    set_shares(limits, motion);
    const double worst = std::max({motion.position_share, motion.speed_share, motion.torque_share});
    if (worst <= 1) return motion;
    scale *= kMargin / worst;
  }
  return std::nullopt;
}

}  // namespace cablefit
