#include "cablefit/simulate/sensitivity/sensitive_axis.hpp"

#include <algorithm>
#include <cmath>

namespace cablefit {

SensitiveAxis::SensitiveAxis(const std::vector<EffectInstance>& effects)
    : effects_(effects), axis_(effects), by_parameter_(effects.size(), 0.0) {
  for (const EffectInstance& instance : effects)
    has_dry_ = has_dry_ || instance.effect->follows == MotionPart::direction;
}

SensitiveAxis::Slide SensitiveAxis::slide(double velocity, double force, double sigma,
                                          double h) const {
  const Axis::Friction& f = axis_.friction();
  Slide out;
  out.sigma = sigma;
  out.end = slid_velocity(inertia(), velocity, force - f.constant - sigma * f.level, f.damping, h);
  out.mean = 0.5 * (velocity + out.end);
  out.push = inertia() / h * (out.end - velocity);
  return out;
}

void SensitiveAxis::add_by_parameter(double factor, const Slide& slide) {
  const double acceleration = slide.push / inertia();
  for (std::size_t k = 0; k < by_parameter_.size(); ++k) {
    const MotionPart part = effects_[k].effect->follows;
    by_parameter_[k] -= factor * (part == MotionPart::acceleration ? acceleration
                                  : part == MotionPart::velocity   ? slide.mean
                                  : part == MotionPart::direction  ? slide.sigma
                                                                   : 1.0);
  }
}

SensitiveAxis::Step SensitiveAxis::moving(double velocity, double force, double sigma, double h) {
  const Slide s = slide(velocity, force, sigma, h);
  const double rate = inertia() / h, half = 0.5 * axis_.friction().damping;
  const double gain = 1 / (rate + half);
  add_by_parameter(gain, s);
  return {s.end, (rate - half) * gain, gain};
}

SensitiveAxis::Step SensitiveAxis::leaving(double force, double h) {
  const double push = force - axis_.friction().constant;
  if (std::abs(push) <= dry_level()) return {};
  const Step step = moving(0.0, force, std::copysign(1.0, push), h);
  if (step.velocity * push > 0) return step;
  std::fill(by_parameter_.begin(), by_parameter_.end(), 0.0);
  return {};
}

// It moves on until tau = -J v / push with friction of v/2, and perhaps leaves the other way (or
// again) in the time that is left. Both times depend on everything the first stretch does.
SensitiveAxis::Step SensitiveAxis::stopping(double velocity, double force, double sigma, double h) {
  const Axis::Friction& f = axis_.friction();
  const double half = 0.5 * f.damping;
  const double push = force - f.constant - half * velocity - sigma * f.level;
  const double until_rest = push * velocity < 0 ? std::min(h, -inertia() * velocity / push) : h;
  const double left = h - until_rest;
  if (!(left > 1e-12 * h)) return {};
  const double at_rest = force - f.constant;
  if (std::abs(at_rest) <= f.level) return {};
  const Slide second = slide(0.0, force, std::copysign(1.0, at_rest), left);
  const double c2 = 1 / (inertia() / left + half);
  const double c1 = c2 * (second.push / left) * (until_rest / push);
  add_by_parameter(c2, second);
  add_by_parameter(c1, {0.0, 0.5 * velocity, push, sigma});
  return {second.end, c1 * (inertia() / until_rest - half), c1 + c2};
}

SensitiveAxis::Step SensitiveAxis::advance(double velocity, double force, double h) {
  std::fill(by_parameter_.begin(), by_parameter_.end(), 0.0);
  if (!has_dry_) return moving(velocity, force, 0.0, h);
  if (velocity == 0) return leaving(force, h);
  const double sigma = std::copysign(1.0, velocity);
  const Step step = moving(velocity, force, sigma, h);
  if (step.velocity * velocity > 0) return step;
  std::fill(by_parameter_.begin(), by_parameter_.end(), 0.0);
  return stopping(velocity, force, sigma, h);
}

}  // namespace cablefit
