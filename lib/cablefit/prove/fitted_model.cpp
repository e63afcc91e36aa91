#include "cablefit/prove/fitted_model.hpp"

#include <fmt/format.h>

#include <cmath>

namespace cablefit {
namespace {

/// The effects of the side that the fit has; what it does not determine is 0.
std::vector<EffectInstance> effects_of(const DynamicFit& fit, Side side, int joint, const Rig& rig,
                                       std::string& why_not) {
  std::vector<EffectInstance> result =
      base_instances(side, joint, rig, [&](const Estimate& blank) -> std::optional<Estimate> {
        const Estimate* e = find_estimate(fit.parameters, blank.name);
        return e == nullptr ? std::nullopt : std::optional(*e);
      });
  for (EffectInstance& instance : result) {
    Estimate& e = instance.parameters.front();
    if (std::isfinite(e.value)) continue;
    e.value = 0;
    if (instance.effect->is_inertia())
      why_not = fmt::format("{} is not identifiable, so the fit cannot be simulated", e.name);
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
    if (!model.rigid) axes.link = effects_of(fit, Side::link, joint, rig, why_not);
    axes.motor = effects_of(fit, model.rigid ? Side::rigid : Side::motor, joint, rig, why_not);
    axes.added = fit.effects;
    if (axes.motor.empty()) why_not = "the model has no motion of its own to simulate";
  }
  if (fit.elastic) model.transmission = fit.elastic->transmission;
  if (rig.arm.kind != nullptr && rig.arm.is_coupled())
    why_not = "--prove is not made for links that move each other";
  return model;
}

}  // namespace cablefit
