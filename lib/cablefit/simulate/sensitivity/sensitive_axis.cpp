#include "cablefit/simulate/sensitivity/sensitive_axis.hpp"

#include <algorithm>
#include <cmath>

namespace cablefit {
namespace {

constexpr int kMaxNewton = 30;
// Of the step in velocity: the next correction is its square, rounding for any friction.
constexpr double kNewtonTolerance = 1e-7;

}  // namespace

SensitiveAxis::SensitiveAxis(const std::vector<EffectInstance>& effects) {
  std::size_t most = 0;
  for (const EffectInstance& instance : effects) {
    const std::size_t n = instance.parameters.size();
    terms_.push_back({instance.effect, parameters_.size(), n});
    for (const Estimate& parameter : instance.parameters) parameters_.push_back(parameter.value);
    has_dry_ = has_dry_ || instance.effect->dry != nullptr;
    most = std::max(most, n);
  }
  by_parameter_.assign(parameters_.size(), 0.0);
  slopes_ = inertia_by_ = by_parameter_;
  scratch_.assign(most + 2, 0.0);
  update();
}

void SensitiveAxis::update() {
  inertia_ = 0;
  for (const Term& term : terms_) {
    if (!term.effect->inertia) continue;
    inertia_ += term.effect->inertia(parameters_.data() + term.first);
    term.effect->inertia_slopes(parameters_.data() + term.first, inertia_by_.data() + term.first);
  }
}

SensitiveAxis::Friction SensitiveAxis::friction(double position, double velocity, double sigma) {
  Friction sum;
  for (const Term& term : terms_) {
    const double* parameters = parameters_.data() + term.first;
    double* slopes = slopes_.data() + term.first;
    if (term.effect->smooth_slopes) {
      sum.torque += term.effect->smooth_slopes(position, velocity, parameters, scratch_.data());
      sum.by_position += scratch_[0];
      sum.by_velocity += scratch_[1];
      for (std::size_t k = 0; k < term.n; ++k) slopes[k] = scratch_[2 + k];
    }
    if (!term.effect->dry_slopes) continue;
    const bool alone = term.effect->smooth_slopes == nullptr;
    sum.torque += sigma * term.effect->dry_slopes(position, velocity, parameters, scratch_.data());
    sum.by_position += sigma * scratch_[0];
    sum.by_velocity += sigma * scratch_[1];
    for (std::size_t k = 0; k < term.n; ++k)
      slopes[k] = (alone ? 0.0 : slopes[k]) + sigma * scratch_[2 + k];
  }
  return sum;
}

double SensitiveAxis::dry_level(double position, double velocity) const {
  double level = 0;
  for (const Term& term : terms_)
    if (term.effect->dry)
      level += term.effect->dry(position, velocity, parameters_.data() + term.first);
  return level;
}

// Newton on J (v' - v) / h = force - friction((v + v') / 2).
SensitiveAxis::Slide SensitiveAxis::slide(double position, double velocity, double force,
                                          double sigma, double h) {
  Slide out;
  out.velocity = velocity;
  const double inertia_rate = inertia_ / h;
  for (int i = 0; i < kMaxNewton; ++i) {
    out.friction = friction(position, 0.5 * (velocity + out.velocity), sigma);
    out.push = force - out.friction.torque;
    const double gap = out.push - inertia_rate * (out.velocity - velocity);
    const double step = gap / (inertia_rate + 0.5 * out.friction.by_velocity);
    out.velocity += step;
    if (!(std::abs(step) > kNewtonTolerance * (std::abs(out.velocity) + std::abs(velocity)))) break;
  }
  out.push = inertia_rate * (out.velocity - velocity);
  return out;
}

void SensitiveAxis::add_by_parameter(double factor, double push) {
  const double by_inertia = push / inertia_;
  for (std::size_t k = 0; k < by_parameter_.size(); ++k)
    by_parameter_[k] -= factor * (slopes_[k] + inertia_by_[k] * by_inertia);
}

SensitiveAxis::Step SensitiveAxis::moving(double position, double velocity, double force,
                                          double sigma, double h) {
  const Slide s = slide(position, velocity, force, sigma, h);
  const double rate = inertia_ / h, half = 0.5 * s.friction.by_velocity;
  const double gain = 1 / (rate + half);
  add_by_parameter(gain, s.push);
  return {s.velocity, (rate - half) * gain, -gain * s.friction.by_position, gain};
}

SensitiveAxis::Step SensitiveAxis::leaving(double position, double force, double h) {
  const double push = force - friction(position, 0.0, 0.0).torque;
  if (std::abs(push) <= dry_level(position, 0.0)) return {};
  Step step = moving(position, 0.0, force, std::copysign(1.0, push), h);
  if (step.velocity * push > 0) return step;
  std::fill(by_parameter_.begin(), by_parameter_.end(), 0.0);
  return {};
}

// It moves on until tau = -J v / push with friction of v/2, and perhaps leaves the other way (or
// again) in the time that is left. Both times depend on everything the first stretch does.
SensitiveAxis::Step SensitiveAxis::stopping(double position, double velocity, double force,
                                            double sigma, double h) {
  const Friction first = friction(position, 0.5 * velocity, sigma);
  const double push = force - first.torque;
  const double until_rest = push * velocity < 0 ? std::min(h, -inertia_ * velocity / push) : h;
  const double left = h - until_rest;
  if (!(left > 1e-12 * h)) return {};
  const double at_rest = force - friction(position, 0.0, 0.0).torque;
  if (std::abs(at_rest) <= dry_level(position, 0.0)) return {};
  const Slide second = slide(position, 0.0, force, std::copysign(1.0, at_rest), left);
  const double c2 = 1 / (inertia_ / left + 0.5 * second.friction.by_velocity);
  const double c1 = c2 * (second.push / left) * (until_rest / push);
  add_by_parameter(c2, second.push);
  friction(position, 0.5 * velocity, sigma);  // its slopes once more
  add_by_parameter(c1, push);
  return {second.velocity, c1 * (inertia_ / until_rest - 0.5 * first.by_velocity),
          -c1 * first.by_position - c2 * second.friction.by_position, c1 + c2};
}

SensitiveAxis::Step SensitiveAxis::advance(double position, double velocity, double force,
                                           double h) {
  std::fill(by_parameter_.begin(), by_parameter_.end(), 0.0);
  if (!has_dry_) return moving(position, velocity, force, 0.0, h);
  if (velocity == 0) return leaving(position, force, h);
  const double sigma = std::copysign(1.0, velocity);
  const Step step = moving(position, velocity, force, sigma, h);
  if (step.velocity * velocity > 0) return step;
  std::fill(by_parameter_.begin(), by_parameter_.end(), 0.0);
  return stopping(position, velocity, force, sigma, h);
}

}  // namespace cablefit
