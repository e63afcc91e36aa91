#include "cablefit/identify/results/identify_model.hpp"

#include <fmt/format.h>

#include "cablefit/dynamic/rows/delay_hold.hpp"
#include "cablefit/model/assembled_model.hpp"
#include "cablefit/model/effects/effects_per_joint.hpp"

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

/// Every equation of the joint was fitted. A link of a coupled arm has no inertia of its own.
bool has_all(const Model& model, const JointModel& axes) {
  const std::size_t n_link = base_effects(Side::link).size() - (model.is_coupled() ? 1 : 0);
  return axes.link.size() == n_link && axes.motor.size() == base_effects(Side::motor).size();
}

void require_inertias(const JointModel& axes, Parameters& parameters) {
  for (const auto* side : {&axes.link, &axes.motor})
    for (const EffectInstance& instance : *side) {
      const Estimate& e = instance.parameters.front();
      if (instance.effect->is_inertia() && !(e.value > 0))
        parameters.refuse(fmt::format("{} is not positive", e.name));
    }
}

/// Effects beyond (31) with what was estimated of them.
EffectsPerJoint added_of(const PreloadFacts& facts, Parameters& parameters) {
  EffectsPerJoint added = facts.added;
  const auto n_joints = static_cast<int>(added.size());
  for (int joint = 0; joint < n_joints; ++joint)
    for (EffectInstance& effect : added[static_cast<std::size_t>(joint)])
      for (std::size_t k = 0; k < effect.parameters.size(); ++k) {
        const ParameterInfo& info = effect.effect->parameters[k];
        const auto e = parameters.find(added_parameter_name(*effect.effect, info, joint, n_joints));
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
  Rig rig = facts.rig;
  rig.transmission = preload.transmission;
  if (rig.torque_hold == TorqueHold::automatic) set_torque_hold(facts.delay, rig);
  const auto find = [&](const Estimate& blank) { return parameters.find(blank.name); };
  Model model = assembled_model(rig, false, find);
  model.name = "poly";
  model.preload = preload.name;
  for (const JointModel& axes : model.joints) {
    if (!has_all(model, axes)) return std::nullopt;
    require_inertias(axes, parameters);
  }
  set_added_effects(added_of(facts, parameters), model);
  model.transmission = preload.transmission;
  model.elastic = elastic_estimates(preload.transmission, facts.rig, find);
  why_not = parameters.why_not();
  return why_not.empty() ? std::optional(std::move(model)) : std::nullopt;
}

}  // namespace cablefit
