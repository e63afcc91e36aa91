#include "cablefit/copies/simulated_copy.hpp"

#include <algorithm>
#include <utility>

#include "cablefit/base/error.hpp"
#include "cablefit/copies/surrogate.hpp"
#include "cablefit/samples/survey/gapless_rows.hpp"
#include "cablefit/samples/survey/noise.hpp"
#include "cablefit/simulate/start_state.hpp"

namespace cablefit {
namespace {

constexpr Eigen::Index kLeastRows = 16;  // a shorter stretch shows no motion

void require_channels(const LogPlan& plan, bool rigid) {
  require_channel(plan, Channel::theta, "the simulated logs of --prove");
  require_channel(plan, Channel::tau, "the simulated logs of --prove");
  if (!rigid) require_channel(plan, Channel::q, "the simulated logs of --prove");
}

void set_start(const LogSurvey& log, CopyStretch& stretch) {
  const PartSurvey& part = log.parts[stretch.part];
  const int n_joints = log.plan.rig.n_joints();
  SimulationInput& input = stretch.input;
  input.q0 = input.qd0 = input.theta0 = input.thetad0 = Eigen::VectorXd::Zero(n_joints);
  const auto state_of = [&](Channel channel, int joint) -> StartState {
    const int slot = log.plan.find(channel, joint);
    if (slot < 0) return {};
    return start_state(stretch.measured.col(slot).array(), 0, input.period,
                       position_noise(log, part, channel, joint));
  };
  for (int joint = 0; joint < n_joints; ++joint) {
    const StartState q = state_of(Channel::q, joint), theta = state_of(Channel::theta, joint);
    input.q0[joint] = q.position;
    input.qd0[joint] = q.velocity;
    input.theta0[joint] = theta.position;
    input.thetad0[joint] = theta.velocity;
  }
}

}  // namespace

std::vector<CopyStretch> read_stretches(const LogSurvey& log, std::size_t number,
                                        const PartFilter& wanted) {
  std::vector<CopyStretch> stretches;
  for_each_run(log, wanted, kLeastRows, 0, [&](GaplessRows&& run) {
    CopyStretch& stretch = stretches.emplace_back();
    stretch.log = number;
    stretch.part = run.part;
    stretch.t0 = run.t0;
    stretch.period = stretch.input.period = run.period;
    stretch.input.t0 = run.t0 - log.parts.front().t_first;
    stretch.measured = std::move(run.data);
  });
  return stretches;
}

SimulatedCopy make_copy(const Model& model, std::span<const LogSurvey> logs,
                        const PartFilter& wanted, const CopyDrive& drive) {
  SimulatedCopy copy;
  copy.model = model;
  copy.step = drive.step;
  for (std::size_t k = 0; k < logs.size(); ++k) {
    const LogSurvey& log = logs[k];
    copy.plans.push_back(log.plan);
    copy.parts.push_back(log.parts);
    if (std::none_of(log.parts.begin(), log.parts.end(), wanted)) continue;
    require_channels(log.plan, model.rigid);
    for (CopyStretch& stretch : read_stretches(log, k, wanted)) {
      stretch.link_blocked = log.parts[stretch.part].phase == Phase::blocked;
      set_start(log, stretch);
      const std::string which = choose_controller(model, log, drive, stretch);
      if (std::find(copy.notes.begin(), copy.notes.end(), which) == copy.notes.end())
        copy.notes.push_back(which);
      copy.stretches.push_back(std::move(stretch));
    }
  }
  return copy;
}

}  // namespace cablefit
