#include "cablefit/simulate/axis.hpp"

namespace cablefit {

Axis::Axis(const std::vector<EffectInstance>& effects) : inertia_(inertia_of(effects)) {
  for (const EffectInstance& instance : effects) {
    const double value = instance.parameters.front().value;
    const MotionPart part = instance.effect->follows;
    if (part == MotionPart::constant) friction_.constant += value;
    if (part == MotionPart::velocity) friction_.damping += value;
    if (part == MotionPart::direction) friction_.level += value;
  }
}

}  // namespace cablefit
