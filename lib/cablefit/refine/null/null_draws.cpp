#include "cablefit/refine/null/null_draws.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "cablefit/base/error.hpp"
#include "cablefit/copies/simulated_copy.hpp"
#include "cablefit/copies/surrogate.hpp"
#include "cablefit/model/one_joint.hpp"
#include "cablefit/refine/null/blocked_copy.hpp"
#include "cablefit/refine/rows/kernel.hpp"
#include "cablefit/refine/rows/levels.hpp"
#include "cablefit/refine/undetermined.hpp"

namespace cablefit {
namespace {

constexpr std::uint64_t kSensors = 11, kCalibration = 12;
// Hz. Below the first a surrogate controller follows the measured motion and torque as they are.
// Up to the second it follows what torque and motion have in common. The rest is sensor noise: as a
// torque it would move a drive that is in stiction. Beyond, the kernels of the rows leave nothing.
constexpr double kFollowCutoff = 10, kDitherCutoff = 150;
// s: a mode of 100 Hz is off by (2 pi 100 h)^2 / 24 = 2e-4 of its frequency, far less than draws
// scatter.
constexpr double kDrawStep = 1e-4;

/// The same motion a little aside, so that its rounding is another.
void move_aside(SimulatedCopy& copy, Random& random) {
  constexpr double kQuanta = 16, kLeast = 1e-4;  // rad
  for (CopyStretch& stretch : copy.stretches) {
    double quantum = 0;
    for (const CopySensor& sensor : copy.sensors[stretch.log])
      quantum = std::max(quantum, sensor.quantum);
    const double aside = std::max(kLeast, kQuanta * quantum) * (random.uniform() - 0.5);
    stretch.input.theta_ref += aside;
    stretch.input.theta0.array() += aside;
    if (!stretch.link_blocked) stretch.input.q0.array() += aside;
  }
}

/// rms of what the rows see of an acceleration.
double rms_acceleration(const Eigen::ArrayXd& theta, double period, const Smoothing& wanted) {
  const Smoothing smoothing = suited(wanted, period);
  const Eigen::ArrayXd rough = apply(gaussian_curvature(smoothing.signals, period), theta);
  const Eigen::ArrayXd smooth = apply(gaussian(smoothing.columns, period), rough);
  return std::sqrt(smooth.square().mean());
}

double range_of(const Eigen::ArrayXd& x) { return x.maxCoeff() - x.minCoeff(); }

/// Whether a joint's moving stretches are as lively as the measured ones, and its blocked sweeps as
/// wide.
bool move_alike(const SimulatedCopy& copy, const std::vector<SimulationResult>& motions, int joint,
                const Smoothing& smoothing) {
  constexpr double kAlike = 1.25;
  for (std::size_t k = 0; k < motions.size(); ++k) {
    const CopyStretch& stretch = copy.stretches[k];
    const int slot = copy.plans[stretch.log].find(Channel::theta, joint);
    const auto size = [&](const Eigen::ArrayXd& theta) {
      return stretch.link_blocked ? range_of(theta)
                                  : rms_acceleration(theta, stretch.period, smoothing);
    };
    const double measured = size(stretch.measured.col(slot).array());
    const double simulated = size(motions[k].theta.col(joint));
    if (simulated > kAlike * measured || measured > kAlike * simulated) return false;
  }
  return true;
}

/// That of one joint among all that the model's copy has.
CopyDisturbance on_joint(const CopyDisturbance& one, const Model& model) {
  if (model.whole == nullptr) return one;
  const auto among_all = [&](const std::vector<ArModel>& own) {
    std::vector<ArModel> all(own.empty() ? 0 : model.whole->joints.size());
    if (!own.empty()) all[static_cast<std::size_t>(model.joint)] = own.front();
    return all;
  };
  return {among_all(one.motor), among_all(one.link)};
}

/// Copies of the logs of one preload.
struct PreloadCopy {
  std::size_t model = 0;
  SimulatedCopy copy;
  std::vector<std::size_t> logs;  ///< number of each recorded log among those given
};

}  // namespace

struct NullBench::Parts {
  std::vector<Model> models;
  std::vector<PreloadCopy> copies;
  BlockedCopy blocked;  ///< of logs that are all blocked, and where no loop of theirs is stable
  Smoothing smoothing;
  CopyDisturbance disturbance;
  double held_back = 0;
  bool follows = false;
};

namespace {

/// The logs as a copy of one preload sees them.
struct CopiedLogs {
  std::span<const Model> models;
  std::span<const LogSurvey> logs;
  const PartFilter& wanted;
  const Smoothing& smoothing;
  int threads;
  bool may_diverge = false;  ///< then the copies follow the measured motion
};

/// The copy follows the measured motion where the rig's controller does not move it so: `follows`.
PreloadCopy make_preload_copy(const CopiedLogs& of, std::size_t m, bool* follows) {
  const Model& model = of.models[m];
  const PartFilter of_model = [&](const PartSurvey& part) {
    return of.wanted(part) && (of.models.size() == 1 || part.preload == model.preload);
  };
  PreloadCopy copy;
  copy.model = m;
  const bool held = model.rig.torque_hold != TorqueHold::none;
  const auto run = [&](bool surrogate) {
    copy.copy = make_copy(
        whole_of(model), of.logs, of_model,
        {held, model.rig.torque_period, kFollowCutoff, surrogate, kDrawStep, kDitherCutoff});
    Random calibration(1, kCalibration);
    return run_copy(copy.copy, {}, calibration, of.threads);
  };
  using Motions = std::optional<std::vector<SimulationResult>>;
  const auto by_controller = [&]() -> Motions { return run(false); };
  Motions motions = of.may_diverge ? unless_undetermined(by_controller) : by_controller();
  const std::vector<LogPlan>& plans = copy.copy.plans;
  const bool has_controller = std::any_of(plans.begin(), plans.end(), has_reference);
  if (!motions || (has_controller && !move_alike(copy.copy, *motions, model.joint, of.smoothing))) {
    motions = run(true);
    *follows = true;
  }
  choose_sensors(copy.copy, *motions);
  for (std::size_t k = 0; k < of.logs.size(); ++k)
    if (std::any_of(copy.copy.stretches.begin(), copy.copy.stretches.end(),
                    [k](const CopyStretch& stretch) { return stretch.log == k; }))
      copy.logs.push_back(k);
  return copy;
}

std::vector<PreloadCopy> make_copies(const CopiedLogs& of, bool* follows) {
  std::vector<PreloadCopy> copies;
  for (std::size_t m = 0; m < of.models.size(); ++m)
    copies.push_back(make_preload_copy(of, m, follows));
  return copies;
}

}  // namespace

NullBench::NullBench(std::span<const Model> models, std::span<const LogSurvey> logs,
                     const PartFilter& wanted, const Smoothing& smoothing, int threads)
    : parts_(std::make_unique<Parts>()) {
  parts_->models.assign(models.begin(), models.end());
  parts_->smoothing = smoothing;
  std::vector<Stretch> all = read_stretches(logs, models, wanted);
  if (is_blocked_only(all)) {
    parts_->blocked = make_blocked_copy(parts_->models, std::move(all), smoothing);
    return;
  }
  // Nothing where a loop is not stable.
  const auto copies_of = [&](const PartFilter& some) {
    return unless_undetermined([&]() -> std::optional<std::vector<PreloadCopy>> {
      return make_copies({models, logs, some, smoothing, threads}, &parts_->follows);
    });
  };
  if (auto copies = copies_of(wanted)) {
    parts_->copies = *std::move(copies);
    return;
  }
  // A loop at the rate of a slow blocked log need not be stable. What is left moves.
  const PartFilter moving = [&](const PartSurvey& part) {
    return wanted(part) && part.phase != Phase::blocked;
  };
  std::erase_if(all, [](const Stretch& stretch) { return !stretch.blocked; });
  auto copies = all.empty() ? std::nullopt : copies_of(moving);
  if (!all.empty()) parts_->blocked = make_blocked_copy(parts_->models, std::move(all), smoothing);
  parts_->copies =
      copies ? *std::move(copies)
             : make_copies({models, logs, moving, smoothing, threads, true}, &parts_->follows);
}

NullBench::~NullBench() = default;

bool NullBench::follows() const { return parts_->follows; }

void NullBench::disturb(const CopyDisturbance& disturbance) { parts_->disturbance = disturbance; }

void NullBench::silence_torque() {
  for (BlockedCopy::Sensors& sensors : parts_->blocked.sensors) sensors.noise_tau = 0;
  for (PreloadCopy& preload : parts_->copies)
    for (std::size_t log = 0; log < preload.copy.plans.size(); ++log)
      for (std::size_t k = 0; k < preload.copy.sensors[log].size(); ++k)
        if (preload.copy.plans[log].slots[k].channel == Channel::tau)
          preload.copy.sensors[log][k].noise = 0;
}

void NullBench::hold_back(double share) { parts_->held_back = share; }

std::vector<NullBench::Recorded> NullBench::record(std::uint64_t seed, int threads) const {
  std::vector<Recorded> all;
  for (const PreloadCopy& copy : parts_->copies) {
    Random random(seed, kSensors + 2 * copy.model);
    SimulatedCopy aside = copy.copy;
    move_aside(aside, random);
    all.push_back(
        {copy.model,
         record_copy(aside,
                     run_copy(aside, on_joint(parts_->disturbance, parts_->models[copy.model]),
                              random, threads),
                     random)});
  }
  return all;
}

std::vector<Stretch> NullBench::draw(std::uint64_t seed, int threads) const {
  const auto& motor = parts_->disturbance.motor;
  std::vector<Stretch> all =
      cablefit::record(parts_->blocked, motor.empty() ? ArModel{} : motor.front(), seed);
  if (parts_->copies.empty()) {
    if (parts_->held_back > 0) hold_out(all, parts_->held_back, HoldOut::all);
    return all;
  }
  const std::vector<Recorded> recorded = record(seed, threads);
  for (std::size_t k = 0; k < recorded.size(); ++k) {
    const std::span<const Model> model(&parts_->models[recorded[k].model], 1);
    for (Stretch& stretch :
         read_stretches(recorded[k].logs, model, [](const PartSurvey&) { return true; })) {
      const PreloadCopy& copy = parts_->copies[k];
      const std::size_t log = copy.logs[stretch.log];
      // Of the log only the parts of this preload were recorded: time counts from its beginning.
      const double late = recorded[k].logs[stretch.log].parts.front().t_first -
                          copy.copy.parts[log].front().t_first;
      for (double Stretch::*t : {&Stretch::t0, &Stretch::part_begin, &Stretch::part_end})
        stretch.*t += late;
      stretch.log = log;
      stretch.model = recorded[k].model;
      all.push_back(std::move(stretch));
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Stretch& a, const Stretch& b) { return a.log < b.log; });
  if (parts_->held_back > 0) hold_out(all, parts_->held_back, HoldOut::moving);
  return all;
}

BaseFit fit_base(Design design, double block_seconds, const KindLevels* levels) {
  constexpr int kRounds = 2;
  BaseFit base;
  base.design = std::move(design);
  base.levels = levels != nullptr ? positive(*levels) : KindLevels{1, 1, 1};
  for (int round = 0; round < kRounds; ++round) {
    base.grams = block_grams(base.design, block_seconds);
    for (int pass = 0; pass < 2; ++pass) {
      auto fit = fit_blocks(base.grams, base.levels);
      if (!fit)
        throw Error(ErrorKind::not_identifiable,
                    "the logs do not determine the parameters of the model; run `cablefit dynamic` "
                    "or `cablefit check` on them to see which");
      base.fit = std::move(*fit);
      if (levels != nullptr) break;
      base.levels = positive(base.fit.rms());
    }
    if (round + 1 < kRounds) base.design = relinearised(base.design, base.fit.x);
  }
  return base;
}

}  // namespace cablefit
