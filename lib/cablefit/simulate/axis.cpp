#include "cablefit/simulate/axis.hpp"

namespace cablefit {

Axis::Axis(const std::vector<EffectInstance>& effects) {
  for (const EffectInstance& instance : effects) add(instance);
}

void Axis::add(const EffectInstance& instance) {
  const Effect& effect = *instance.effect;
  const std::size_t first = parameters_.size();
  for (const Estimate& parameter : instance.parameters) parameters_.push_back(parameter.value);
  const double* parameters = parameters_.data() + first;
  if (effect.inertia) inertia_ += effect.inertia(parameters);
  if (effect.is_affine) {
    fold(effect, parameters);
    return;
  }
  if (effect.smooth) smooth_.push_back({effect.smooth, first});
  if (effect.dry) dry_.push_back({effect.dry, first});
}

void Axis::fold(const Effect& effect, const double* parameters) {
  if (effect.smooth) {
    const double constant = effect.smooth(0, 0, parameters);
    affine_.constant += constant;
    affine_.damping += effect.smooth(0, 1, parameters) - constant;
  }
  if (effect.dry) affine_.level += effect.dry(0, 0, parameters);
}

}  // namespace cablefit
