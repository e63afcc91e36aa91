#include "cablefit/design/excitation/excitation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "cablefit/base/error.hpp"
#include "cablefit/base/parallel.hpp"
#include "cablefit/base/random.hpp"
#include "cablefit/design/curves/joint_curve.hpp"
#include "cablefit/model/joint_inertias.hpp"
#include "cablefit/model/stiffness.hpp"

namespace cablefit {
namespace {

constexpr double kSearchStep = 200e-6;   // s; as exact as a choice of motions needs
constexpr double kRateShare = 1.0 / 40;  // of the rate, for the highest frequency
constexpr double kResonanceShare = 1.0 / 3;
constexpr double kLeastPeriods = 4;  // at least, of the fastest part of a motion
constexpr int kSineFrequencies = 16;
constexpr double kFirstChange = 0.25, kSmallestChange = 0.01;  // of the numbers' range
constexpr double kGrow = 1.3, kShrink = 0.75;
constexpr double kChanged = 0.5;       // share of the numbers that a change moves
constexpr double kFinestStep = 25e-6;  // s

/// Hz; 0 when nothing is elastic.
double lowest_resonance(const Model& model) {
  if (model.rigid) return 0;
  double lowest = kUnbounded;
  const std::vector<double> links = link_inertias(model);
  for (std::size_t k = 0; k < model.joints.size(); ++k) {
    const JointCurve curve(model.transmission, static_cast<int>(k));
    const double stiffness = (curve.stiffness(1e-6) + curve.stiffness(-1e-6)) / 2;
    lowest =
        std::min(lowest, free_resonance(stiffness, inertia_of(model.joints[k].motor), links[k]));
  }
  return lowest;
}

ShapeFrame frame_of(const Model& model, const ExcitationLimits& limits) {
  ShapeFrame frame{limits.duration, 1 / limits.rate, limits.max_position, limits.max_speed,
                   kRateShare * limits.rate};
  const double f0 = lowest_resonance(model);
  if (f0 > 0) frame.highest_frequency = std::min(frame.highest_frequency, kResonanceShare * f0);
  if (frame.highest_frequency * frame.duration < kLeastPeriods)
    throw usage_error(
        fmt::format("{:g} s are too short for a motion of this drive", frame.duration),
        fmt::format("it can be moved at up to {:.3g} Hz (a third of its free resonance at rest, a "
                    "fortieth of the sample rate): give --duration of at least {:.2g}",
                    frame.highest_frequency, kLeastPeriods / frame.highest_frequency));
  return frame;
}

/// One motion in question: numbers per joint.
struct Candidate {
  Eigen::ArrayXXd numbers;  ///< n_numbers x joints
  double objective = kUnbounded;
};

class Judge {
 public:
  Judge(const Model& model, const ExcitationOptions& options, const MotionShape& shape,
        const ExcitationObjective& objective)
      : model_(model),
        options_(options),
        shape_(shape),
        objective_(objective),
        frame_(frame_of(model, options.limits)),
        start_(at_rest(model, options.limits, kFinestStep)) {}

  std::optional<ExcitedMotion> motion(const Eigen::ArrayXXd& numbers, double step) const {
    Eigen::ArrayXXd unit;
    for (Eigen::Index k = 0; k < numbers.cols(); ++k) {
      const Eigen::ArrayXd own = shape_.position(frame_, numbers.col(k));
      if (unit.size() == 0) unit.resize(own.size(), numbers.cols());
      unit.col(k) = own / std::max(1e-300, own.abs().maxCoeff());
    }
    return motion_within(model_, options_.limits, start_, unit, shape_.share(numbers.col(0)), step);
  }

  /// The objectives of all, side by side.
  void judge(std::vector<Candidate>& candidates) const {
    std::size_t done = 0;
    ordered_pipeline<std::size_t>(
        options_.threads,
        [&](auto emit) {
          for (std::size_t k = 0; k < candidates.size(); ++k) emit(std::size_t{k});
        },
        [&](std::size_t k) {
          const auto moved = motion(candidates[k].numbers, kSearchStep);
          return moved ? objective_(*moved) : kUnbounded;
        },
        [&](double value) { candidates[done++].objective = value; });
  }

  /// Where the shape wants to start, every joint alike.
  std::vector<Eigen::ArrayXXd> starts() const {
    std::vector<Eigen::ArrayXXd> all;
    if (shape_.starts == nullptr) return all;
    for (const Eigen::ArrayXd& numbers : shape_.starts())
      all.emplace_back(numbers.replicate(1, static_cast<Eigen::Index>(model_.joints.size())));
    return all;
  }

  Eigen::ArrayXXd draw(Random& random) const {
    Eigen::ArrayXXd numbers(shape_.n_numbers, static_cast<Eigen::Index>(model_.joints.size()));
    for (double& x : numbers.reshaped()) x = random.uniform();
    return numbers;
  }

 private:
  const Model& model_;
  const ExcitationOptions& options_;
  const MotionShape& shape_;
  const ExcitationObjective& objective_;
  ShapeFrame frame_;
  SimulationInput start_;
};

/// Some of the numbers moved, mirrored back into 0 .. 1.
Eigen::ArrayXXd changed(const Eigen::ArrayXXd& numbers, double step, Random& random) {
  Eigen::ArrayXXd out = numbers;
  for (double& x : out.reshaped()) {
    const double move = step * random.normal();
    if (random.uniform() > kChanged) continue;
    x = std::abs(std::fmod(x + move, 2.0));
    if (x > 1) x = 2 - x;
  }
  return out;
}

const Candidate& best_of(const std::vector<Candidate>& candidates) {
  return *std::min_element(
      candidates.begin(), candidates.end(),
      [](const Candidate& a, const Candidate& b) { return a.objective < b.objective; });
}

Error no_motion(const ExcitationOptions& options) {
  const ExcitationLimits& l = options.limits;
  return Error(
      ErrorKind::not_identifiable,
      fmt::format("no {} of {:g} s within {:g} rad, {:g} rad/s and {:g} N m determines every "
                  "parameter; raise a limit (load and friction alone may need all of the "
                  "torque), or raise --duration",
                  options.shape, l.duration, l.max_position, l.max_speed, l.max_torque));
}

Excitation finished(const Judge& judge, const Candidate& best, const ExcitationOptions& options,
                    const ExcitationObjective& objective, int n_tried) {
  if (!std::isfinite(best.objective)) throw no_motion(options);
  auto motion = judge.motion(best.numbers, kFinestStep);
  if (!motion) throw no_motion(options);
  Excitation found;
  found.motion = std::move(*motion);
  found.objective = objective(found.motion);
  found.numbers = best.numbers;
  found.n_tried = n_tried;
  return found;
}

/// The best sine of these frequencies, each 0 (the lowest) to 1 (the highest).
Excitation sine_of(const std::vector<double>& numbers, const Model& model,
                   const ExcitationOptions& options, const ExcitationObjective& objective) {
  const Judge judge(model, options, sine_shape(), objective);
  std::vector<Candidate> all;
  for (const double number : numbers)
    all.push_back(
        {Eigen::ArrayXXd::Constant(1, static_cast<Eigen::Index>(model.joints.size()), number)});
  judge.judge(all);
  const Candidate& best = best_of(all);
  Excitation found = finished(judge, best, options, objective, static_cast<int>(all.size()));
  const ShapeFrame frame = frame_of(model, options.limits);
  const double lowest = 2 / frame.duration;
  found.hz = lowest * std::pow(frame.highest_frequency / lowest, best.numbers(0, 0));
  return found;
}

}  // namespace

ExcitedMotion any_motion(const Model& model, const ExcitationOptions& options) {
  const ExcitationObjective none;
  const Judge judge(model, options, find_motion_shape(options.shape), none);
  Random random(options.seed);
  for (int i = 0; i < options.n_random; ++i)
    if (auto motion = judge.motion(judge.draw(random), kSearchStep)) return std::move(*motion);
  throw no_motion(options);
}

Excitation search_excitation(const Model& model, const ExcitationOptions& options,
                             const ExcitationObjective& objective) {
  const Judge judge(model, options, find_motion_shape(options.shape), objective);
  Random random(options.seed);
  std::vector<Candidate> drawn;
  if (options.from.size() > 0) {
    drawn.push_back({options.from});
  } else {
    for (int i = 0; i < options.n_random; ++i) drawn.push_back({judge.draw(random)});
    for (const Eigen::ArrayXXd& numbers : judge.starts()) drawn.push_back({numbers});
  }
  judge.judge(drawn);
  Candidate best = best_of(drawn);
  double step = kFirstChange;
  int n_changed = 0;
  for (int i = 0; i < options.n_generations && step > kSmallestChange; ++i) {
    std::vector<Candidate> next(static_cast<std::size_t>(options.per_generation));
    for (Candidate& candidate : next) candidate.numbers = changed(best.numbers, step, random);
    judge.judge(next);
    n_changed += options.per_generation;
    const Candidate& first = best_of(next);
    const bool better = first.objective < best.objective;
    if (better) best = first;
    step *= better ? kGrow : kShrink;
  }
  return finished(judge, best, options, objective, static_cast<int>(drawn.size()) + n_changed);
}

Excitation plain_sine(const Model& model, const ExcitationOptions& options,
                      const ExcitationObjective& objective) {
  const ShapeFrame frame = frame_of(model, options.limits);
  const double lowest = 2 / frame.duration;
  const double hz =
      std::clamp(options.limits.max_speed / (2 * std::numbers::pi * options.limits.max_position),
                 lowest, frame.highest_frequency);
  const double number = std::log(hz / lowest) / std::log(frame.highest_frequency / lowest);
  return sine_of({number}, model, options, objective);
}

Excitation best_sine(const Model& model, const ExcitationOptions& options,
                     const ExcitationObjective& objective) {
  std::vector<double> numbers;
  for (int k = 0; k < kSineFrequencies; ++k)
    numbers.push_back(static_cast<double>(k) / (kSineFrequencies - 1));
  return sine_of(numbers, model, options, objective);
}

}  // namespace cablefit
