#include "cablefit/simulate/corrections.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace cablefit {
namespace {

constexpr std::array<std::pair<Channel, Eigen::ArrayXd Recording::*>, 4> kSignals{
    {{Channel::q, &Recording::q},
     {Channel::theta, &Recording::theta},
     {Channel::tau, &Recording::tau},
     {Channel::tau_load, &Recording::tau_load}}};

bool corrects(const EffectInstance& instance) { return instance.effect->correct != nullptr; }

}  // namespace

bool corrects(const Model& model) {
  return std::any_of(model.joints.begin(), model.joints.end(), [](const JointModel& joint) {
    return std::any_of(joint.added.begin(), joint.added.end(),
                       [](const EffectInstance& instance) { return corrects(instance); });
  });
}

void correct(const std::vector<EffectInstance>& refinements, Recording& recording) {
  for (const EffectInstance& instance : refinements) {
    if (!corrects(instance)) continue;
    std::vector<double> values;
    for (const Estimate& parameter : instance.parameters) values.push_back(parameter.value);
    instance.effect->correct(values.data(), recording);
  }
}

void correct(const Model& model, const LogPlan& plan, bool commands, Window& window) {
  for (std::size_t joint = 0; joint < model.joints.size(); ++joint) {
    Recording recording;
    recording.period = window.period;
    const auto slot = [&](Channel channel) { return plan.find(channel, static_cast<int>(joint)); };
    for (const auto& [channel, signal] : kSignals)
      if (slot(channel) >= 0) recording.*signal = window.data.col(slot(channel)).array();
    correct(model.joints[joint].added, recording);
    for (const auto& [channel, signal] : kSignals)
      if (slot(channel) >= 0 && !(commands && channel == Channel::tau))
        window.data.col(slot(channel)) = (recording.*signal).matrix();
  }
}

}  // namespace cablefit
