#include "cablefit/refine/search/trial_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cablefit/model/one_joint.hpp"
#include "cablefit/simulate/simulator.hpp"

namespace cablefit {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;
constexpr double kSeconds = 20, kRampIn = 1;
constexpr double kSlow = 0.1, kFast = 0.9;  // of the largest speed seen
constexpr double kShaken = 0.2;             // of the largest acceleration seen
constexpr double kSomeLoad = 0.3;           // of the largest torque, where no load was on

/// What the logs have seen of the motor.
struct Limits {
  double low = kUnbounded, high = -kUnbounded, speed = 0, acceleration = 0;  ///< rad, rad/s, ...
  double deflection = 0;                                                     ///< rad
  std::vector<double> loads;                                                 ///< N m, per stretch
  double period = 0;
};

double most_of(const Eigen::ArrayXd& values) {
  const Eigen::ArrayXd amounts = values.abs();
  return cablefit::most_of(std::vector<double>(amounts.begin(), amounts.end()));
}

Limits limits_of(const Design& design) {
  Limits limits;
  for (std::size_t k = 0; k < design.stretches.size(); ++k) {
    const SmoothMotion& m = *design.rows[k].motion;
    for (const JointState& state : design.states[k])
      limits.deflection = std::max(limits.deflection, std::abs(state.deflection));
    if (design.stretches[k].blocked) continue;
    limits.period = m.period;
    limits.low = std::min(limits.low, m.theta.minCoeff());
    limits.high = std::max(limits.high, m.theta.maxCoeff());
    limits.speed = std::max(limits.speed, most_of(m.thetad));
    limits.acceleration = std::max(limits.acceleration, most_of(m.thetadd));
    limits.loads.push_back(m.tau_load.mean());
  }
  return limits;
}

/// Three sines that take the whole travel and no more than the speed, from rest; with shaking when
/// there is an acceleration (rad/s^2) for it.
Eigen::ArrayXd reference(const Limits& limits, double speed, double shaken) {
  constexpr double kRatios[] = {1, 1.7, 2.9}, kShares[] = {0.6, 0.25, 0.15};
  constexpr double kShakes[] = {7, 13, 23};
  const double travel = 0.5 * (limits.high - limits.low);
  // Speed of the three at their largest: 2 pi f travel sum(ratio share).
  double spread = 0;
  for (int i = 0; i < 3; ++i) spread += kRatios[i] * kShares[i];
  const double lowest = 2 / kSeconds;
  const double f = std::max(lowest, speed / (kTwoPi * travel * spread));
  const double size = std::min(travel, speed / (kTwoPi * f * spread));
  const auto n = static_cast<Eigen::Index>(kSeconds / limits.period);
  const Eigen::ArrayXd t =
      limits.period * Eigen::ArrayXd::LinSpaced(n, 0, static_cast<double>(n - 1));
  const Eigen::ArrayXd in = (t / kRampIn).min(1);
  Eigen::ArrayXd theta = Eigen::ArrayXd::Zero(n);
  for (int i = 0; i < 3; ++i) theta += size * kShares[i] * (kTwoPi * f * kRatios[i] * t).sin();
  for (const double shake : kShakes) {
    const double w = kTwoPi * shake;
    theta += shaken / (3 * w * w) * (w * t).sin();
  }
  return 0.5 * (limits.high + limits.low) + in * in * (3 - 2 * in) * theta;
}

/// From 0 to one side, to the other and back, twice.
Eigen::ArrayXd triangle(double height, double period) {
  const auto n = static_cast<Eigen::Index>(kSeconds / period);
  Eigen::ArrayXd x(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double phase = std::fmod(2.0 * static_cast<double>(i) / static_cast<double>(n), 1.0);
    x(i) = height * (phase < 0.25 ? 4 * phase : phase < 0.75 ? 2 - 4 * phase : 4 * phase - 4);
  }
  return x;
}

/// The loads to try: what is on, none, the other way, half.
std::vector<double> loads_of(const Limits& limits, double peak) {
  double largest = 0;
  for (const double load : limits.loads)
    if (std::abs(load) > std::abs(largest)) largest = load;
  if (std::abs(largest) < 0.01 * peak) {
    largest = kSomeLoad * peak;
    return {0, largest, -largest};
  }
  return {largest, 0, -largest, largest / 2};
}

Controller stiff_controller(const Model& model, double period) {
  constexpr double kGain = 0.2;  // kd period / J_motor; a sampled loop is unstable at 2
  const JointModel& joint = model.joints.front();
  const double motor = inertia_of(joint.motor), all = motor + inertia_of(joint.link);
  Controller controller;
  controller.kd = kGain * motor / period;
  // Damped with the whole inertia: kp = kd^2 / (2 J).
  controller.kp = controller.kd * controller.kd / (2 * all);
  return controller;
}

}  // namespace

std::string text_of(const TrialRun& run, Axes axes) {
  const std::string unit = unit_for(axes, "rad/s");
  if (run.blocked) return "with the link blocked, a slow ramp up to the peak torque on both sides";
  const std::string load =
      run.load == 0 ? "without load"
                    : fmt::format("at a load of {:+.3g} {}", run.load, torque_unit(axes));
  return fmt::format("{} and up to {:.2g} {}{}", load, run.speed, unit,
                     run.dithered ? " with a small dither" : "");
}

std::vector<TrialRun> trial_runs(const Design& design) {
  std::vector<TrialRun> runs;
  const Limits limits = limits_of(design);
  if (!(limits.period > 0) || !(limits.high > limits.low) || !(limits.speed > 0)) return runs;
  const double slow = std::max(kSlow * limits.speed, 3 * design.smoothing.least_speed_theta);
  for (const double load : loads_of(limits, design.scale.peak)) {
    runs.push_back({load, slow, false, false, limits.period, reference(limits, slow, 0)});
    runs.push_back({load, kFast * limits.speed, true, false, limits.period,
                    reference(limits, kFast * limits.speed, kShaken * limits.acceleration)});
  }
  if (!design.models.front().rigid && limits.deflection > 0)
    runs.push_back({0, 4 * limits.deflection * 2 / kSeconds, false, true, limits.period,
                    triangle(limits.deflection, limits.period)});
  return runs;
}

std::optional<Stretch> simulated(const TrialRun& run, const Model& given) {
  Model model = standing_alone(given);
  if (!model.rig.controller) model.rig.controller = stiff_controller(model, run.period);
  model.rig.load = Load{};
  const Eigen::Index n = run.theta_ref.size();
  SimulationInput input;
  input.period = run.period;
  input.theta_ref = run.theta_ref;
  input.tau_load = Eigen::ArrayXXd::Constant(n, 1, run.load);
  input.theta0 = input.q0 = Eigen::VectorXd::Constant(1, run.blocked ? 0 : run.theta_ref(0));
  input.qd0 = input.thetad0 = Eigen::VectorXd::Zero(1);
  SimulationOptions options;
  options.closed_loop = true;
  options.link_blocked = run.blocked;
  const SimulationResult motion = simulate(model, input, options);
  if (motion.diverged_at) return {};
  Stretch stretch;
  stretch.blocked = run.blocked;
  stretch.recording = {run.period, motion.q.col(0), motion.theta.col(0), motion.tau.col(0),
                       input.tau_load.col(0)};
  if (given.whole == nullptr) return stretch;
  Recording& r = stretch.recording;  // the other links stand at 0
  r.links = Eigen::ArrayXXd::Zero(n, static_cast<Eigen::Index>(linked_joints(given).size()));
  r.joint = own_place(given);
  r.links.col(r.joint) = r.q;
  return stretch;
}

}  // namespace cablefit
