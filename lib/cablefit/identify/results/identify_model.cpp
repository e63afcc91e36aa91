#include "cablefit/identify/results/identify_model.hpp"

#include <fmt/format.h>

#include "cablefit/model/effects/effect_parameter.hpp"

namespace cablefit {
namespace {

/// Every number that a model of this preload needs, or what it lacks.
class Parameters {
 public:
  Parameters(const IdentifyResult& result, const IdentifyPreload& preload)
      : all_(result.parameters) {
    all_.insert(all_.end(), preload.parameters.begin(), preload.parameters.end());
  }

  std::optional<Estimate> find(std::string_view name) {
    const Estimate* e = find_estimate(all_, name);
    if (e == nullptr) return std::nullopt;
    if (!e->not_identifiable.empty()) refuse(fmt::format("{} is not identifiable", name));
    return *e;
  }
  void refuse(const std::string& reason) {
    if (why_not_.empty()) why_not_ = reason;
  }
  const std::string& why_not() const { return why_not_; }

 private:
  std::vector<Estimate> all_;
  std::string why_not_;
};

/// Empty: its equation was not fitted. `joint`: from 1.
std::vector<EffectInstance> effects_of(Side side, int joint, const Rig& rig,
                                       Parameters& parameters) {
  std::vector<EffectInstance> instances = base_instances(
      side, joint, rig, [&](const Estimate& blank) { return parameters.find(blank.name); });
  if (instances.size() < base_effects(side).size()) return {};
  for (const EffectInstance& instance : instances) {
    const Estimate& e = instance.parameters.front();
    if (instance.effect->is_inertia() && !(e.value > 0))
      parameters.refuse(fmt::format("{} is not positive", e.name));
  }
  return instances;
}

/// Effects beyond (31) with what was estimated of them.
std::vector<EffectInstance> added_of(const PreloadFacts& facts, Parameters& parameters) {
  std::vector<EffectInstance> added = facts.added;
  for (EffectInstance& effect : added)
    for (std::size_t k = 0; k < effect.parameters.size(); ++k) {
      const ParameterInfo& info = effect.effect->parameters[k];
      const auto e = parameters.find(added_parameter_name(*effect.effect, info));
      if (!e) continue;  // held
      effect.parameters[k] = *e;
      effect.parameters[k].name = info.name;
    }
  return added;
}

}  // namespace

std::optional<Model> model_of(const IdentifyResult& result, const IdentifyPreload& preload,
                              const PreloadFacts& facts, std::string& why_not) {
  Parameters parameters(result, preload);
  if (facts.arm != nullptr && facts.arm->is_coupled()) {
    if (facts.has_moving)
      why_not = fmt::format("the links of a {} arm cannot be simulated", facts.arm->kind->name);
    return std::nullopt;
  }
  Model model;
  model.name = "poly";
  model.preload = preload.name;
  model.rig = facts.rig;
  model.rig.transmission = preload.transmission;
  if (model.rig.torque_hold == TorqueHold::automatic)
    model.rig.torque_hold = facts.delay.held ? TorqueHold::zoh : TorqueHold::none;
  for (int joint = 1; joint <= facts.rig.n_joints(); ++joint) {
    model.joints.push_back({effects_of(Side::link, joint, facts.rig, parameters),
                            effects_of(Side::motor, joint, facts.rig, parameters)});
    if (model.joints.back().link.empty() || model.joints.back().motor.empty()) return std::nullopt;
  }
  model.joints.front().added = added_of(facts, parameters);
  model.transmission = preload.transmission;
  for (const Cable& cable : preload.transmission.cables)
    for (int k = 0; k < cable.n_coefficients(); ++k)
      if (const auto e = parameters.find(coefficient_name(cable, k, facts.rig.cables_given)))
        model.elastic.push_back(*e);
  for (const Cable& cable : preload.transmission.cables)
    if (const auto e = parameters.find(elongation_name(cable))) model.elastic.push_back(*e);
  why_not = parameters.why_not();
  return why_not.empty() ? std::optional(std::move(model)) : std::nullopt;
}

}  // namespace cablefit
