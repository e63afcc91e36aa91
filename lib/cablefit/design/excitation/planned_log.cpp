#include "cablefit/design/excitation/planned_log.hpp"

#include <fmt/format.h>

#include "cablefit/base/error.hpp"
#include "cablefit/base/random.hpp"
#include "cablefit/samples/survey/noise.hpp"
#include "cablefit/samples/survey/recorded.hpp"

namespace cablefit {
namespace {

constexpr std::uint64_t kSeed = 20261;

bool load_is_column(const Rig& rig) { return rig.load.law == nullptr || rig.load.law->from_column; }

std::vector<Channel> channels_of(const Model& model) {
  std::vector<Channel> channels;
  if (!model.rigid) channels.push_back(Channel::q);
  channels.push_back(Channel::theta);
  channels.push_back(Channel::tau);
  if (load_is_column(model.rig)) channels.push_back(Channel::tau_load);
  return channels;
}

std::string indexed(Channel channel, int joint, int n_joints) {
  const std::string name(channel_name(channel));
  return n_joints > 1 ? name + std::to_string(joint + 1) : name;
}

/// Every sensor under its own name; throws for one of which nothing is known.
void spell_out_sensors(const std::vector<Channel>& channels, Rig& rig) {
  for (const Channel channel : channels) {
    if (channel == Channel::tau_load) continue;
    for (int joint = 0; joint < rig.n_joints(); ++joint) {
      const std::string name = indexed(channel, joint, rig.n_joints());
      const auto shared = rig.sensors.find(std::string(channel_name(channel)));
      if (rig.sensors.count(name) == 0 && shared != rig.sensors.end())
        rig.sensors[name] = shared->second;
      const auto found = rig.sensors.find(name);
      if (found != rig.sensors.end() && (found->second.noise || found->second.quantum)) continue;
      throw input_error(
          {rig.path}, fmt::format("the noise of sensor {} is unknown", name),
          fmt::format(
              "add \"sensors\": {{\"{}\": {{\"{}\": ...}}}} to the rig; the expected sd need "
              "it",
              name, channel == Channel::tau ? "noise" : "quantum"));
    }
  }
}

/// Rows x slots of the plan.
Eigen::MatrixXd slots_of(const ExcitedMotion& motion, const std::vector<Slot>& slots) {
  const SimulationResult& r = motion.result;
  Eigen::MatrixXd data(r.theta.rows(), static_cast<Eigen::Index>(slots.size()));
  for (std::size_t k = 0; k < slots.size(); ++k) {
    const Eigen::ArrayXXd& from = slots[k].channel == Channel::q       ? r.q
                                  : slots[k].channel == Channel::theta ? r.theta
                                  : slots[k].channel == Channel::tau   ? r.tau
                                                                       : motion.input.tau_load;
    data.col(static_cast<Eigen::Index>(k)) = from.col(slots[k].joint);
  }
  return data;
}

LogPlan plan_of(const Model& model) {
  Rig rig = model.rig;
  rig.torque_hold = TorqueHold::zoh;  // as it is simulated; an expected sd is the same without
  rig.path.clear();
  const std::vector<Channel> channels = channels_of(model);
  spell_out_sensors(channels, rig);
  LogPlan plan = recorded_plan("the planned motion", rig, {});
  for (const Channel channel : channels)
    for (int joint = 0; joint < rig.n_joints(); ++joint) {
      plan.slots.push_back({channel, joint, plan.header.columns.size(), 1, 0});
      plan.header.columns.push_back(
          {indexed(channel, joint, rig.n_joints()), "", {plan.path, 1, 0}});
    }
  return plan;
}

LogSurvey survey_of(const LogPlan& plan, const Eigen::MatrixXd& data, double period) {
  RecordedPart part{"default", "", Phase::moving, true, {}};
  part.rows.resize(data.rows(), data.cols() + 1);
  part.rows.rightCols(data.cols()) = data;
  for (Eigen::Index i = 0; i < data.rows(); ++i) part.rows(i, 0) = static_cast<double>(i) * period;
  return survey_recorded(plan, {part});
}

}  // namespace

LogSurvey planned_log(const Model& model, const ExcitedMotion& motion) {
  const LogPlan plan = plan_of(model);
  return survey_of(plan, slots_of(motion, plan.slots), motion.period);
}

/// The motion as one window of its log.
Window window_of(const ExcitedMotion& motion, const LogSurvey& log) {
  Window window;
  window.data = slots_of(motion, log.plan.slots);
  window.approach = Eigen::MatrixXd::Zero(window.data.rows(), log.plan.rig.n_joints());
  window.end = window.data.rows();
  window.starts_segment = window.ends_segment = true;
  window.period = motion.period;
  return window;
}

Window with_noise(Window window, const LogSurvey& log, std::uint64_t draw) {
  Random random(kSeed, draw);
  for (std::size_t k = 0; k < log.plan.slots.size(); ++k) {
    const Slot& slot = log.plan.slots[k];
    if (slot.channel == Channel::tau_load) continue;  // known
    const double sd = position_noise(log, log.parts.front(), slot.channel, slot.joint);
    for (double& value : window.data.col(static_cast<Eigen::Index>(k)))
      value += sd * random.normal();
  }
  return window;
}

/// As it will be recorded: settings are chosen by what the noise looks like.
LogSurvey noisy_log(const Model& model, const ExcitedMotion& motion) {
  const LogSurvey clean = planned_log(model, motion);
  return survey_of(clean.plan, with_noise(window_of(motion, clean), clean, 0).data, motion.period);
}

}  // namespace cablefit
