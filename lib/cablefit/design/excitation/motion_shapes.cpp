#include "cablefit/design/excitation/motion_shapes.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "cablefit/base/catalog.hpp"

namespace cablefit {
namespace {

constexpr double kTau = 2 * std::numbers::pi;
constexpr double kFade = 0.04;  // of the duration, at either end, in which a motion grows from 0
constexpr double kSlowestPeriods = 2;  // of the slowest sine
constexpr Eigen::Index kSines = 5;
constexpr Eigen::Index kPerSine = 3;  // frequency, amplitude, phase
constexpr Eigen::Index kMoves = 10;
constexpr Eigen::Index kPerMove = 3;  // target, speed, acceleration time
constexpr double kLeastShare = 0.4;
constexpr double kSlowest = 0.03;                   // of the speed limit
constexpr double kSharpest = 0.02, kSoftest = 0.5;  // s, to the speed

Eigen::ArrayXd times(const ShapeFrame& frame) {
  const auto n = static_cast<Eigen::Index>(std::floor(frame.duration / frame.period + 0.5)) + 1;
  return Eigen::ArrayXd::LinSpaced(n, 0, static_cast<double>(n - 1) * frame.period);
}

/// Even in its logarithm.
double between(double low, double high, double share) { return low * std::pow(high / low, share); }

/// 0 at both ends, smooth up to its second derivative.
Eigen::ArrayXd faded(const Eigen::ArrayXd& x, const Eigen::ArrayXd& t) {
  const double end = t(t.size() - 1), width = kFade * end;
  const auto rise = [](double s) {
    const double u = std::min(1.0, std::max(0.0, s));
    return u * u * u * (10 + u * (6 * u - 15));
  };
  Eigen::ArrayXd out = x;
  for (Eigen::Index i = 0; i < x.size(); ++i)
    out(i) *= rise(t(i) / width) * rise((end - t(i)) / width);
  return out;
}

double lowest_frequency(const ShapeFrame& frame) { return kSlowestPeriods / frame.duration; }

Eigen::ArrayXd multi_sine(const ShapeFrame& frame, const Eigen::ArrayXd& numbers) {
  const Eigen::ArrayXd t = times(frame);
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(t.size());
  for (Eigen::Index k = 0; k < kSines; ++k) {
    const double hz =
        between(lowest_frequency(frame), frame.highest_frequency, numbers(kPerSine * k));
    // The same number is the same speed, whatever the frequency.
    const double amplitude = std::pow(numbers(kPerSine * k + 1), 2) / hz;
    sum += amplitude * (kTau * (hz * t + numbers(kPerSine * k + 2))).sin();
  }
  return faded(sum, t);
}

/// A strong sine and a weaker, faster one: alone, its acceleration would follow its position.
std::vector<Eigen::ArrayXd> pairs_of_sines() {
  std::vector<Eigen::ArrayXd> all;
  for (const double strong : {0.05, 0.15, 0.25, 0.35, 0.45, 0.55, 0.65})
    for (const double faster : {0.2, 0.4})
      for (const double share : {0.15, 0.4}) {
        Eigen::ArrayXd numbers = Eigen::ArrayXd::Zero(kPerSine * kSines + 1);
        numbers(0) = strong;
        numbers(1) = 1;
        numbers(kPerSine) = std::min(1.0, strong + faster);
        numbers(kPerSine + 1) = std::sqrt(share);
        for (Eigen::Index k = 2; k < kSines; ++k) numbers(kPerSine * k) = strong;
        numbers(kPerSine * kSines) = 1;
        all.push_back(numbers);
      }
  return all;
}

double multi_sine_share(const Eigen::ArrayXd& numbers) {
  return kLeastShare + (1 - kLeastShare) * numbers(numbers.size() - 1);
}

Eigen::ArrayXd sine(const ShapeFrame& frame, const Eigen::ArrayXd& numbers) {
  const Eigen::ArrayXd t = times(frame);
  const double hz = between(lowest_frequency(frame), frame.highest_frequency, numbers(0));
  return faded((kTau * hz * t).sin(), t);
}

double whole(const Eigen::ArrayXd& /*numbers*/) { return 1; }

/// Way after a time s on a trapezoid of speed over `way` (>= 0), with this speed and time to it.
struct Trapezoid {
  double way, speed, rise;
  Trapezoid(double length, double fastest, double seconds)
      : way(length), speed(fastest), rise(seconds) {
    if (speed * rise <= way) return;
    // Too short to reach the speed at this acceleration.
    const double acceleration = speed / rise;
    rise = std::sqrt(way / acceleration);
    speed = acceleration * rise;
  }
  double duration() const { return way > 0 ? rise + way / speed : 0; }
  double at(double s) const {
    if (way == 0) return 0;
    const double end = duration();
    if (s < rise) return 0.5 * speed / rise * s * s;
    if (s > end - rise) return way - 0.5 * speed / rise * std::pow(std::max(0.0, end - s), 2);
    return speed * (s - rise / 2);
  }
};

/// Moves one after the other, again and again until the time is over; the last one goes home.
Eigen::ArrayXd trapezoids(const ShapeFrame& frame, const Eigen::ArrayXd& numbers) {
  const Eigen::ArrayXd t = times(frame);
  Eigen::ArrayXd out(t.size());
  double from = 0, begin = 0;
  Eigen::Index move = 0, row = 0;
  while (row < t.size()) {
    const Eigen::Index k = kPerMove * (move % kMoves);
    // Back and forth, so that both directions have their share.
    const double target = frame.max_position * (move % 2 == 0 ? 1 : -1) * (0.1 + 0.9 * numbers(k));
    const Trapezoid profile(std::abs(target - from),
                            between(kSlowest * frame.max_speed, frame.max_speed, numbers(k + 1)),
                            between(kSharpest, kSoftest, numbers(k + 2)));
    const double sign = target < from ? -1 : 1;
    for (; row < t.size() && t(row) < begin + profile.duration(); ++row)
      out(row) = from + sign * profile.at(t(row) - begin);
    begin += profile.duration();
    from = target;
    ++move;
  }
  return out;
}

constexpr std::array kShapes{
    MotionShape{"multisine", "five sines of any frequency, amplitude and phase at once",
                "Swevers et al. 1997", kPerSine* kSines + 1, multi_sine, multi_sine_share,
                pairs_of_sines},
    MotionShape{"trapezoid", "ten moves with trapezoidal speed, repeated",
                "Khalil & Dombre 2004, ch. 13", kPerMove* kMoves, trapezoids, whole},
};

constexpr MotionShape kSine{"sine", "one sine", "", 1, sine, whole};

}  // namespace

std::span<const MotionShape> motion_shapes() { return kShapes; }

const MotionShape& find_motion_shape(std::string_view name) {
  return find_row(motion_shapes(), "shape", name);
}

const MotionShape& sine_shape() { return kSine; }

}  // namespace cablefit
