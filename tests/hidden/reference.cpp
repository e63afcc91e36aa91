#include "reference.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "random.hpp"

namespace hidden {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;
constexpr double kPeriod = 1e-3;  // s, of the controller

void add_line(Reference& to, double frequency, double amplitude, double phase) {
  const auto turn = std::polar(1.0, kTwoPi * frequency * kPeriod);
  auto value = std::polar(amplitude, phase);
  for (double& x : to) {
    x += value.imag();
    value *= turn;
  }
}

/// 0 until 0.1 s, 1 from 1 s on, with two continuous derivatives.
double fade_in(double t) {
  const double x = std::clamp((t - 0.1) / 0.9, 0.0, 1.0);
  return x * x * x * (10 + x * (6 * x - 15));
}

Reference samples(double seconds) {
  return Reference(static_cast<std::size_t>(std::lround(seconds / kPeriod)), 0.0);
}

Reference dither(const Multisine& spec, const Bench& bench, Random& random) {
  Reference out = samples(spec.seconds);
  const double amplitude = spec.dither * std::sqrt(2.0 / 40);
  for (double f = 5.5; f < 45; f += 1) {
    const auto difference = 1.0 - std::polar(1.0, -kTwoPi * f * kPeriod);
    const double gain = std::abs(bench.kp + bench.kd / kPeriod * difference);
    add_line(out, f, amplitude / gain, random.uniform(0, kTwoPi));
  }
  return out;
}

}  // namespace

Reference multisine(const Multisine& spec, const Bench& bench) {
  Random random(spec.seed, "reference");
  Reference out = samples(spec.seconds);
  for (double f = spec.lowest; f <= spec.highest; f += 0.05)
    add_line(out, f, std::pow(f, -spec.fall), random.uniform(0, kTwoPi));
  const auto [least, most] = std::minmax_element(out.begin(), out.end());
  const double scale = spec.peak / std::max(-*least, *most);
  const Reference fast = dither(spec, bench, random);
  for (std::size_t k = 0; k < out.size(); ++k)
    out[k] = fade_in(static_cast<double>(k) * kPeriod) * (scale * out[k] + fast[k]);
  return out;
}

Reference sweep(double seconds, double range, const Bench& bench) {
  Reference out = samples(seconds);
  for (std::size_t k = 0; k < out.size(); ++k) {
    const double t = static_cast<double>(k) * kPeriod;
    const double size = range * (0.65 + 0.35 * std::cos(kTwoPi * t / 13));
    const double phi = fade_in(t) * size * std::sin(kTwoPi * t / 5);
    out[k] = phi + bench.rig.tau_elas(phi) / bench.kp;
  }
  return out;
}

}  // namespace hidden
