#include "cablefit/dynamic/output_error/log_stretches.hpp"

#include <algorithm>

#include "cablefit/samples/survey/noise.hpp"

namespace cablefit {
namespace {

constexpr Eigen::Index kLeastRows = 16;  // a shorter stretch shows no motion
// A simulated log without rounding still has that of its text.
constexpr double kLeastNoise = 1e-10;  // of the range of the channel

using Grown = std::vector<double>;  // rows x slots, row by row

/// The column of a channel for `n` joints from `first` on; no rows where one does not have it.
Eigen::ArrayXXd channel(const LogPlan& plan, const Grown& rows, Channel wanted, int n,
                        int first = 0) {
  const auto n_slots = static_cast<Eigen::Index>(plan.slots.size());
  using Table = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::Map<const Table> all(rows.data(), static_cast<Eigen::Index>(rows.size()) / n_slots,
                                    n_slots);
  Eigen::ArrayXXd out(all.rows(), n);
  for (int joint = 0; joint < n; ++joint) {
    const int slot = plan.find(wanted, first + joint);
    if (slot < 0) return {};
    out.col(joint) = all.col(slot);
  }
  return out;
}

MeasuredStretch stretch_of(const DynamicJob& job, const LogPlan& plan, const Grown& rows,
                           bool simulated) {
  const int n = job.n_joints(), first = simulated ? n : 0;
  MeasuredStretch stretch;
  stretch.hold_torque = job.settings.rows.signal.torque_held;
  if (!job.rigid) stretch.q = channel(plan, rows, Channel::q, n, first);
  stretch.theta = channel(plan, rows, Channel::theta, n, first);
  stretch.tau = channel(plan, rows, Channel::tau, n);
  stretch.tau_load = channel(plan, rows, Channel::tau_load, n);
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
  for (const LogSurvey& log : logs) {
    Grown rows;
    WindowPlace first;  // of the stretch that grows
    const auto finish = [&] {
      if (rows.empty()) return;
      stretches.push_back(stretch_of(job, log.plan, rows, simulated));
      stretches.back().period = first.period;
      stretches.back().t0 = first.t0 - log.parts.front().t_first;
      rows.clear();
    };
    for_each_window(log, job.wanted, 0, kLeastRows, bridge_seconds(job.settings.rows.signal),
                    [&](Window&& window) {
                      if (window.begin == 0) {
                        finish();
                        first = window;
                      }
                      for (Eigen::Index i = 0; i < window.data.rows(); ++i)
                        rows.insert(rows.end(), window.data.row(i).begin(),
                                    window.data.row(i).end());
                      return true;
                    });
    finish();
  }
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
