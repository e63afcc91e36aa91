#include "cablefit/refine/null/blocked_twin.hpp"

#include <algorithm>
#include <cmath>

#include "cablefit/base/random.hpp"
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
Eigen::ArrayXd torque_of(const RefinementInstance& instance, const std::vector<JointState>& states,
                         const Eigen::ArrayXd& direction, double period) {
  const Refinement& row = *instance.refinement;
  std::vector<double> shape, z(row.n_states), link(row.n_linear()), motor(row.n_linear());
  for (std::size_t p = row.n_linear(); p < instance.parameters.size(); ++p)
    shape.push_back(instance.parameters[p].value);
  const auto sum = [&](const std::vector<double>& unit) {
    double torque = 0;
    for (std::size_t p = 0; p < unit.size(); ++p) torque += unit[p] * instance.parameters[p].value;
    return torque;
  };
  Eigen::ArrayXd tau = Eigen::ArrayXd::Zero(direction.size());
  for (Eigen::Index i = 0; i < tau.size(); ++i) {
    const JointState& state = states[static_cast<std::size_t>(i)];
    if (row.advance != nullptr) row.advance(state, shape.data(), period / 2, z.data());
    std::fill(motor.begin(), motor.end(), 0.0);
    if (row.torque != nullptr) row.torque(state, shape.data(), z.data(), link.data(), motor.data());
    tau(i) += sum(motor);
    if (row.level != nullptr && row.site == Site::motor) {
      std::fill(motor.begin(), motor.end(), 0.0);
      row.level(state, direction(i), shape.data(), z.data(), motor.data());
      tau(i) += direction(i) * sum(motor);
    }
    if (row.advance != nullptr) row.advance(state, shape.data(), period / 2, z.data());
  }
  return tau;
}

Eigen::ArrayXd torque_of(const Model& model, const SmoothMotion& m, double least_speed) {
  const Eigen::ArrayXd direction = directions(m.thetad, least_speed);
  Eigen::ArrayXd tau(m.size());
  const std::vector<JointState> states = joint_states(m, model);
  for (Eigen::Index i = 0; i < m.size(); ++i) tau(i) = states[static_cast<std::size_t>(i)].tau_elas;
  for (const RefinementInstance& instance : model.joints.front().refinements)
    tau += torque_of(instance, states, direction, m.period);
  for (const EffectInstance& instance : model.joints.front().motor) {
    const auto n = static_cast<Eigen::Index>(instance.effect->n_linear());
    Eigen::MatrixXd columns(m.size(), n);
    instance.effect->regressor({m.theta, m.thetad, m.thetadd, direction}, columns);
    for (Eigen::Index k = 0; k < n; ++k)
      tau += columns.col(k).array() * instance.parameters[static_cast<std::size_t>(k)].value;
  }
  return tau;
}

/// What is logged of a torque that is held until the next row.
Eigen::ArrayXd as_logged(const Eigen::ArrayXd& tau, bool held) {
  Eigen::ArrayXd out = tau;
  if (held)
    for (Eigen::Index i = 0; i + 1 < tau.size(); ++i) out(i) = 0.5 * (tau(i) + tau(i + 1));
  return out;
}

ChannelSurvey look_at(const Eigen::ArrayXd& x) {
  ChannelScan scan;
  scan.add(x);
  return scan.result();
}

BlockedTwin::Sensors sensors_of(const Rig& rig, const Recording& r) {
  const auto find = [&](const char* name) {
    const auto found = rig.sensors.find(name);
    return found != rig.sensors.end() ? found->second : SensorInfo{};
  };
  const SensorInfo theta = find("theta"), tau = find("tau");
  const ChannelSurvey seen = look_at(r.theta);
  BlockedTwin::Sensors sensors;
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

BlockedTwin make_blocked_twin(const std::vector<Model>& models, std::vector<Stretch> stretches,
                              const Smoothing& wanted) {
  BlockedTwin twin;
  for (Stretch& stretch : stretches) {
    const Smoothing smoothing = suited(wanted, stretch.recording.period);
    const Model& model = models[stretch.model];
    twin.sensors.push_back(sensors_of(model.rig, stretch.recording));
    const bool held = model.rig.torque_hold != TorqueHold::none;
    const SmoothMotion m = smooth_motion_of(stretch.recording, stretch.t0, held, smoothing);
    stretch.recording.theta = m.theta;
    stretch.recording.tau = as_logged(torque_of(model, m, smoothing.least_speed_theta), held);
  }
  twin.stretches = std::move(stretches);
  return twin;
}

std::vector<Stretch> record(const BlockedTwin& twin, const ArModel& disturbance,
                            std::uint64_t seed) {
  std::vector<Stretch> out = twin.stretches;
  Random random(seed, kStream);
  for (std::size_t k = 0; k < out.size(); ++k) {
    Recording& r = out[k].recording;
    if (disturbance.sd > 0) r.tau += draw(disturbance, r.tau.size(), r.period, random);
    const BlockedTwin::Sensors& sensors = twin.sensors[k];
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
