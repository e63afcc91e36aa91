#include "cablefit/refine/null/blocked_copy.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cablefit/base/random.hpp"
#include "cablefit/model/effects/effect_walk.hpp"
#include "cablefit/samples/survey/channel_scan.hpp"

namespace cablefit {
namespace {

constexpr std::uint64_t kStream = 13;

/// sgn of the speed; as it was last where the axis is slower than `least`.
Eigen::ArrayXd directions(const Eigen::ArrayXd& speed, double least) {
  Eigen::ArrayXd out(speed.size());
  double last = 0;
  for (Eigen::Index i = 0; i < speed.size(); ++i) {
    if (std::abs(speed(i)) > least) last = speed(i) > 0 ? 1 : -1;
    out(i) = last;
  }
  return out;
}

/// Torque of an effect on the motor, along the motion.
Eigen::ArrayXd torque_of(const EffectInstance& instance, const std::vector<JointState>& states,
                         const Eigen::ArrayXd& direction, double period) {
  const Effect& row = *instance.effect;
  Eigen::ArrayXd tau = Eigen::ArrayXd::Zero(direction.size());
  if (!acts_as_torque(row)) return tau;
  const std::size_t n = row.n_linear();
  std::vector<double> shape, link(n), motor(n);
  for (std::size_t p = n; p < instance.parameters.size(); ++p)
    shape.push_back(instance.parameters[p].value);
  EffectWalk walk(row, std::move(shape));
  for (Eigen::Index i = 0; i < tau.size(); ++i) {
    std::fill(motor.begin(), motor.end(), 0.0);
    walk.step(states[static_cast<std::size_t>(i)], direction(i), period, link.data(), motor.data());
    for (std::size_t p = 0; p < n; ++p) tau(i) += motor[p] * instance.parameters[p].value;
  }
  return tau;
}

Eigen::ArrayXd torque_of(const Model& model, const SmoothMotion& m, const Smoothing& smoothing) {
  const Eigen::ArrayXd direction = directions(m.thetad, smoothing.least_speed_blocked);
  Eigen::ArrayXd tau(m.size());
  const std::vector<JointState> states = joint_states(m, model, smoothing);
  for (Eigen::Index i = 0; i < m.size(); ++i) tau(i) = states[static_cast<std::size_t>(i)].tau_elas;
  for (const EffectInstance& instance : model.joints.front().added)
    tau += torque_of(instance, states, direction, m.period);
  tau += base_torque(model.joints.front().motor, {m.theta, m.thetad, m.thetadd, direction}).array();
  return tau;
}

/// What is logged of a torque that acts so late, see torque_lateness.
Eigen::ArrayXd as_logged(const Eigen::ArrayXd& tau, double late) {
  Eigen::ArrayXd out = tau;
  if (late > 0)
    for (Eigen::Index i = 0; i + 1 < tau.size(); ++i)
      out(i) = (1 - late) * tau(i) + late * tau(i + 1);
  return out;
}

ChannelSurvey look_at(const Eigen::ArrayXd& x) {
  ChannelScan scan;
  scan.add(x);
  return scan.result();
}

BlockedCopy::Sensors sensors_of(const Rig& rig, const Recording& r) {
  const auto find = [&](const char* name) {
    const auto found = rig.sensors.find(name);
    return found != rig.sensors.end() ? found->second : SensorInfo{};
  };
  const SensorInfo theta = find("theta"), tau = find("tau");
  const ChannelSurvey seen = look_at(r.theta);
  BlockedCopy::Sensors sensors;
  sensors.quantum = theta.quantum.value_or(seen.quantum);
  const double rounding = sensors.quantum * sensors.quantum / 12;
  sensors.noise_theta = theta.noise ? *theta.noise
                        : theta.quantum
                            ? 0
                            : std::sqrt(std::max(0.0, seen.noise * seen.noise - rounding));
  sensors.noise_tau = tau.noise.value_or(look_at(r.tau).noise);
  return sensors;
}

}  // namespace

BlockedCopy make_blocked_copy(const std::vector<Model>& models, std::vector<Stretch> stretches,
                              const Smoothing& wanted) {
  BlockedCopy copy;
  for (Stretch& stretch : stretches) {
    const Smoothing smoothing = suited(wanted, stretch.recording.period);
    const Model& model = models[stretch.model];
    copy.sensors.push_back(sensors_of(model.rig, stretch.recording));
    const double late = torque_lateness(model.rig, stretch.recording.period);
    const SmoothMotion m = smooth_motion_of(stretch.recording, stretch.t0, late, smoothing, false);
    stretch.recording.theta = m.theta;
    stretch.recording.tau = as_logged(torque_of(model, m, smoothing), late);
  }
  copy.stretches = std::move(stretches);
  return copy;
}

std::vector<Stretch> record(const BlockedCopy& copy, const ArModel& disturbance,
                            std::uint64_t seed) {
  std::vector<Stretch> out = copy.stretches;
  Random random(seed, kStream);
  for (std::size_t k = 0; k < out.size(); ++k) {
    Recording& r = out[k].recording;
    if (disturbance.sd > 0) r.tau += draw(disturbance, r.tau.size(), r.period, random);
    const BlockedCopy::Sensors& sensors = copy.sensors[k];
    for (double& tau : r.tau) tau += sensors.noise_tau * random.normal();
    if (sensors.noise_theta > 0)
      for (double& theta : r.theta) theta += sensors.noise_theta * random.normal();
    const double quantum = sensors.quantum;
    if (!(quantum > 0)) continue;
    // A little aside, so that the rounding is another each time.
    const double aside = quantum * random.uniform();
    r.theta = quantum * ((r.theta + aside) / quantum).round() - aside;
  }
  return out;
}

}  // namespace cablefit
