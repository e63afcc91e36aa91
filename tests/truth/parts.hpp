// What the truth simulators of a joint (rig.hpp) and of a rigid drive (drive.hpp) are made of.
// Internal to tests/truth.
#ifndef CABLEFIT_TESTS_TRUTH_PARTS_HPP_
#define CABLEFIT_TESTS_TRUTH_PARTS_HPP_

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include "rig.hpp"

namespace truth {

inline constexpr double kTwoPi = 2.0 * std::numbers::pi;
inline constexpr double kRampTime = 0.5;  // s, smooth start of every reference
inline constexpr double kReferenceQuantum =
    1e-6;  // rad, so that the printed reference is the used one

inline double quantise(double value, double quantum) {
  return quantum > 0.0 ? quantum * std::round(value / quantum) : value;
}

// Rises smoothly from 0 to 1 while x goes from 0 to 1; continuous acceleration.
inline double smooth_step(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * x * (10.0 + x * (6.0 * x - 15.0));
}

// Random numbers that are the same with every standard library: the distributions of <random> are
// not specified bit by bit, the engine is.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  // Uniform in [0, 1).
  double uniform() { return static_cast<double>(engine_() >> 11U) * 0x1p-53; }

  // Standard normal, polar method.
  double normal() {
    if (has_spare_) {
      has_spare_ = false;
      return spare_;
    }
    double u = 0.0;
    double v = 0.0;
    double s = 0.0;
    do {
      u = 2.0 * uniform() - 1.0;
      v = 2.0 * uniform() - 1.0;
      s = u * u + v * v;
    } while (s >= 1.0 || s == 0.0);
    const double scale = std::sqrt(-2.0 * std::log(s) / s);
    spare_ = v * scale;
    has_spare_ = true;
    return u * scale;
  }

 private:
  std::mt19937_64 engine_;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

// Separate streams, so that e.g. turning the noise off leaves the motion as it is.
inline Random stream(std::uint64_t seed, std::uint64_t purpose) {
  return Random(seed * 0x9E3779B97F4A7C15ULL + purpose);
}
inline constexpr std::uint64_t kReferenceStream = 1;
inline constexpr std::uint64_t kNoiseStream = 2;
inline constexpr std::uint64_t kDisturbanceStream = 3;

// One inertia with viscous and Coulomb friction.
struct Body {
  double inertia;
  double viscous;
  double coulomb;

  // Velocity after a step h with the constant driving torque. A step in which the velocity reaches
  // zero is split there: the body then stands exactly still unless the driving torque exceeds the
  // Coulomb torque, so that it truly sticks and never chatters.
  double advance(double velocity, double driving, double h) const {
    if (velocity == 0.0) return leave_rest(driving, h);
    const double friction = std::copysign(coulomb, velocity);
    const double end = glide(velocity, driving - friction, h);
    if (end * velocity > 0.0) return end;
    const double time_to_stop = h * velocity / (velocity - end);
    return leave_rest(driving, h - time_to_stop);
  }

 private:
  double leave_rest(double driving, double h) const {
    if (std::abs(driving) <= coulomb) return 0.0;
    return glide(0.0, driving - std::copysign(coulomb, driving), h);
  }

  // Without a change of direction; trapezoidal rule for the viscous friction.
  double glide(double velocity, double net, double h) const {
    const double damping = 0.5 * h * viscous / inertia;
    return (velocity * (1.0 - damping) + h * net / inertia) / (1.0 + damping);
  }
};

class PdController {
 public:
  PdController(const CommonOptions& options, double period, double reference, double theta)
      : options_(options), period_(period), reference_(reference), theta_(theta) {}

  double command(double reference, double theta) {
    const double error_rate = ((reference - reference_) - (theta - theta_)) / period_;
    reference_ = reference;
    theta_ = theta;
    const double tau = options_.kp * (reference - theta) + options_.kd * error_rate;
    return std::clamp(tau, -options_.limit, options_.limit);
  }

 private:
  const CommonOptions& options_;
  double period_;
  double reference_;  // of the previous command
  double theta_;      // of the previous command
};

// Ornstein-Uhlenbeck torque: exact at the samples, linear in between.
class Disturbance {
 public:
  Disturbance(double sd, double correlation_time, double period, std::uint64_t seed)
      : random_(stream(seed, kDisturbanceStream)),
        decay_(sd > 0.0 ? std::exp(-period / correlation_time) : 0.0),
        kick_(sd * std::sqrt(1.0 - decay_ * decay_)),
        next_(sd * random_.normal()) {
    advance();
  }

  void advance() {
    now_ = next_;
    next_ = decay_ * next_ + kick_ * random_.normal();
  }
  double at(double fraction) const { return now_ + fraction * (next_ - now_); }

 private:
  Random random_;
  double decay_;
  double kick_;
  double now_ = 0.0;
  double next_;
};

struct Line {
  double omega;      // rad/s
  double amplitude;  // rad
  double phase;      // rad
};

inline double sum_of(const std::vector<Line>& lines, double t) {
  double sum = 0.0;
  for (const Line& line : lines) sum += line.amplitude * std::sin(line.omega * t + line.phase);
  return sum;
}

// Eight lines, 0.1..2 Hz. Amplitudes fall slower than 1/f, so that the speed keeps changing; scaled
// to reach exactly `peak` away from the start within the duration, whatever the phases are.
inline std::vector<Line> slow_lines(double peak, double duration, Random* random) {
  constexpr std::array<double, 8> kFrequencies{0.1, 0.17, 0.29, 0.47, 0.73, 1.1, 1.5, 2.0};
  std::vector<Line> lines;
  for (const double f : kFrequencies) {
    lines.push_back({kTwoPi * f, std::pow(f, -0.7), kTwoPi * random->uniform()});
  }
  double largest = 0.0;
  for (double t = 0.0; t < duration; t += 0.01)
    largest = std::max(largest, std::abs(sum_of(lines, t)));
  for (Line& line : lines) line.amplitude *= peak / largest;
  return lines;
}

// Forty lines, 4..45 Hz, one in each equal interval. The acceleration grows with frequency: the
// link resonates near 10 Hz and would take all the torque otherwise.
inline std::vector<Line> fast_lines(double rms_acceleration, Random* random) {
  constexpr int kLines = 40;
  constexpr double kLow = 4.0;
  constexpr double kHigh = 45.0;
  std::vector<Line> lines;
  double mean_square = 0.0;
  for (int i = 0; i < kLines; ++i) {
    const double omega = kTwoPi * (kLow + (kHigh - kLow) * (i + random->uniform()) / kLines);
    lines.push_back({omega, 1.0 / omega, kTwoPi * random->uniform()});
    mean_square += 0.5 * omega * omega;
  }
  for (Line& line : lines) line.amplitude *= rms_acceleration / std::sqrt(mean_square);
  return lines;
}

}  // namespace truth

#endif  // CABLEFIT_TESTS_TRUTH_PARTS_HPP_
