#include "cablefit/prove/model_to_simulate.hpp"

#include <fmt/format.h>

#include <cmath>

#include "cablefit/dynamic/fit_model.hpp"

namespace cablefit {
namespace {

/// What the fit does not determine becomes 0.
void settle(std::vector<EffectInstance>& effects, std::string& why_not) {
  for (EffectInstance& instance : effects) {
    Estimate& e = instance.parameters.front();
    if (std::isfinite(e.value)) continue;
    e.value = 0;
    if (instance.effect->is_inertia())
      why_not = fmt::format("{} is not identifiable, so the fit cannot be simulated", e.name);
  }
}

}  // namespace

Model model_to_simulate(const DynamicFit& fit, const DynamicPreload& preload, const Rig& rig,
                        std::string& why_not) {
  why_not.clear();
  Model model = model_of(fit, preload, rig);
  for (JointModel& axes : model.joints) {
    settle(axes.link, why_not);
    settle(axes.motor, why_not);
    if (axes.motor.empty()) why_not = "the model has no motion of its own to simulate";
  }
  return model;
}

}  // namespace cablefit
