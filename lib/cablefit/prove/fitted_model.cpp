#include "cablefit/prove/fitted_model.hpp"

#include <fmt/format.h>

#include <cmath>

#include "cablefit/model/effect_choice.hpp"

namespace cablefit {
namespace {

/// The effects of the side that the fit has.
std::vector<EffectInstance> effects_of(const DynamicFit& fit, Side side, int joint, int n_joints,
                                       std::string& why_not) {
  const auto find = [&](std::string_view name) {
    return find_estimate(fit.parameters, joint_parameter_name(name, joint, n_joints));
  };
  const auto has = [&](std::string_view name) { return find(name) != nullptr; };
  std::vector<EffectInstance> result;
  for (const Effect* effect : effects_with(side, has)) {
    EffectInstance instance{effect, {}};
    for (const ParameterInfo& info : effect->parameters) {
      const Estimate* e = find(info.name);
      if (e == nullptr) break;
      instance.parameters.push_back(*e);
      if (std::isfinite(e->value)) continue;
      instance.parameters.back().value = 0;
      if (effect->inertia != nullptr)
        why_not = fmt::format("{} is not identifiable, so the fit cannot be simulated", e->name);
    }
    if (instance.parameters.size() == effect->parameters.size()) result.push_back(instance);
  }
  return result;
}

}  // namespace

Model fitted_model(const DynamicFit& fit, const DynamicPreload& preload, const Rig& rig,
                   std::string& why_not) {
  why_not.clear();
  Model model;
  model.name = fit.model;
  model.preload = preload.name;
  model.rig = rig;
  model.rigid = !fit.elastic;
  const int n = rig.n_joints();
  for (int joint = 1; joint <= n; ++joint) {
    JointModel& axes = model.joints.emplace_back();
    if (!model.rigid) axes.link = effects_of(fit, Side::link, joint, n, why_not);
    axes.motor = effects_of(fit, model.rigid ? Side::rigid : Side::motor, joint, n, why_not);
    axes.refinements = fit.effects;
    if (axes.motor.empty()) why_not = "the model has no motion of its own to simulate";
  }
  if (fit.elastic) model.transmission = fit.elastic->transmission;
  if (rig.arm.kind != nullptr && rig.arm.is_coupled())
    why_not = "links that move each other are not simulated yet";
  return model;
}

}  // namespace cablefit
