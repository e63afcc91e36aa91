#include "cablefit/dynamic/output_error/log_stretches.hpp"

#include <algorithm>

#include "cablefit/samples/survey/gapless_rows.hpp"
#include "cablefit/samples/survey/noise.hpp"

namespace cablefit {
namespace {

constexpr Eigen::Index kLeastRows = 16;  // a shorter stretch shows no motion
// A simulated log without rounding still has that of its text.
constexpr double kLeastNoise = 1e-10;  // of the range of the channel

/// The columns of a channel for `n` joints from `first` on; no rows where one does not have it.
Eigen::ArrayXXd channel(const LogPlan& plan, const GaplessRows& run, Channel wanted, int n,
                        int first = 0) {
  Eigen::ArrayXXd out(run.data.rows(), n);
  for (int joint = 0; joint < n; ++joint) {
    const int slot = plan.find(wanted, first + joint);
    if (slot < 0) return {};
    out.col(joint) = run.data.col(slot);
  }
  return out;
}

MeasuredStretch stretch_of(const DynamicJob& job, const LogSurvey& log, const GaplessRows& run,
                           bool simulated) {
  const int n = job.n_joints(), first = simulated ? n : 0;
  MeasuredStretch stretch;
  stretch.period = run.period;
  stretch.t0 = run.t0 - log.parts.front().t_first;
  stretch.hold_torque = job.settings.rows.signal.torque_held;
  if (!job.rigid) stretch.q = channel(log.plan, run, Channel::q, n, first);
  stretch.theta = channel(log.plan, run, Channel::theta, n, first);
  stretch.tau = channel(log.plan, run, Channel::tau, n);
  stretch.tau_load = channel(log.plan, run, Channel::tau_load, n);
  return stretch;
}

double noise_of(const LogSurvey& log, const PartSurvey& part, Channel channel, int joint) {
  const ChannelSurvey& c = part.channels[static_cast<std::size_t>(log.plan.find(channel, joint))];
  return std::max({position_noise(log, part, channel, joint), kLeastNoise * (c.max - c.min),
                   std::numeric_limits<double>::min()});
}

}  // namespace

std::vector<MeasuredStretch> measured_stretches(const DynamicJob& job,
                                                std::span<const LogSurvey> logs, bool simulated) {
  std::vector<MeasuredStretch> stretches;
  for (const LogSurvey& log : logs)
    for_each_run(
        log, job.wanted, kLeastRows, bridge_seconds(job.settings.rows.signal),
        [&](GaplessRows&& run) { stretches.push_back(stretch_of(job, log, run, simulated)); });
  return stretches;
}

Eigen::VectorXd position_noise_of(const DynamicJob& job) {
  const Eigen::Index n_joints = job.n_joints();
  Eigen::VectorXd sd = Eigen::VectorXd::Zero(job.rigid ? n_joints : 2 * n_joints);
  for (const LogSurvey& log : job.logs)
    for (const PartSurvey& part : log.parts) {
      if (!job.wanted(part)) continue;
      for (int joint = 0; joint < job.n_joints(); ++joint) {
        double& motor = sd[job.rigid ? joint : n_joints + joint];
        motor = std::max(motor, noise_of(log, part, Channel::theta, joint));
        if (!job.rigid) sd[joint] = std::max(sd[joint], noise_of(log, part, Channel::q, joint));
      }
    }
  return sd;
}

}  // namespace cablefit
