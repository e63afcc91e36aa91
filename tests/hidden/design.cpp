#include "design.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "random.hpp"

namespace hidden {
namespace {

constexpr double kHighPreload = 5.12e-3;  // rad, l_o of cable 1; balanced by 4.67 mrad of cable 2

/// Slow: creeps through zero speed. Fast: shakes what sits between motor and link.
struct Manner {
  std::string_view name;
  double highest, fall, peak, dither;

  Multisine spec(double seconds, std::uint64_t seed) const {
    return {seconds, 0.05, highest, fall, peak, dither, seed};
  }
};
constexpr Manner kSlow{"slow", 0.5, 1, 0.5, 0};
constexpr Manner kFast{"fast", 2, 0.3, 0.6, 6};
constexpr Manner kMedium{"medium", 1.2, 0.5, 0.5, 3};

class Builder {
 public:
  Builder(std::uint64_t seed, const Bench& bench, double seconds)
      : seed_(seed), bench_(bench), seconds_(seconds) {}

  Builder& moving(const Manner& manner, double load, std::string_view role) {
    Run run = next(role);
    run.name = std::string(role == "test" ? "test_" : "") + std::string(manner.name) + "_load" +
               std::to_string(std::lround(load));
    run.load = load;
    const auto seed = seed_ * 64 + static_cast<std::uint64_t>(run.number);
    run.reference = multisine(manner.spec(seconds_, seed), bench_);
    runs_.push_back(run);
    return *this;
  }
  Builder& blocked() {
    Run run = next("blocked");
    run.name = "blocked";
    run.blocked = true;
    Bench bench = bench_;
    if (l_o_ != 0) bench.rig = preloaded(bench.rig, l_o_);
    run.reference = sweep(seconds_, 0.035, bench);
    runs_.push_back(run);
    return *this;
  }
  Builder& preload(std::string name, double l_o) {
    preload_ = std::move(name);
    l_o_ = l_o;
    return *this;
  }
  std::vector<Run> runs() const { return runs_; }

 private:
  Run next(std::string_view role) const {
    Run run;
    run.role = role;
    run.number = static_cast<int>(runs_.size());
    run.preload = preload_;
    run.l_o = l_o_;
    return run;
  }
  std::uint64_t seed_;
  const Bench& bench_;
  double seconds_;
  std::string preload_;
  double l_o_ = 0;
  std::vector<Run> runs_;
};

Builder full_of(std::uint64_t seed, const Bench& bench, double seconds) {
  Builder build(seed, bench, seconds);
  return build.blocked()
      .moving(kSlow, 30, "train")
      .moving(kFast, -40, "train")
      .moving(kSlow, 0, "train")
      .moving(kFast, 0, "train")
      .moving(kMedium, 20, "test")
      .moving(kFast, -25, "test");
}

std::vector<Run> full(std::uint64_t seed, const Bench& bench) {
  return full_of(seed, bench, 20).runs();
}
std::vector<Run> brief(std::uint64_t seed, const Bench& bench) {
  return full_of(seed, bench, 6).runs();
}

std::vector<Run> one_load(std::uint64_t seed, const Bench& bench) {
  Builder build(seed, bench, 20);
  return build.moving(kSlow, 30, "train")
      .moving(kFast, 30, "train")
      .moving(kMedium, 30, "test")
      .runs();
}

std::vector<Run> preloads(std::uint64_t seed, const Bench& bench) {
  Builder build(seed, bench, 20);
  for (const auto& [name, l_o] : {std::pair{"low", 0.0}, std::pair{"high", kHighPreload}})
    build.preload(name, l_o)
        .blocked()
        .moving(kSlow, 30, "train")
        .moving(kFast, -40, "train")
        .moving(kMedium, -20, "test");
  return build.runs();
}

Run extra_run(const CaseSpec& spec, const Bench& bench, const std::vector<Run>& others) {
  Run run;
  run.name = "extra";
  run.blocked = spec.extra->blocked;
  run.role = run.blocked ? "blocked" : "train";
  run.number = static_cast<int>(others.size());
  run.load = run.blocked ? 0 : spec.extra->load;
  run.reference = spec.extra->reference;
  if (run.reference.empty()) run.reference = multisine(kFast.spec(20, spec.seed * 64 + 63), bench);
  return run;
}

/// Somewhere in the middle of a training run, while it moves: a push on a joint at rest may vanish
/// in its friction.
void place_event(Random& random, const std::vector<Run>& runs, Draw& draw) {
  std::vector<const Run*> train;
  for (const Run& run : runs)
    if (run.role == "train" && run.name != "extra") train.push_back(&run);
  for (int attempt = 0; attempt < 100; ++attempt) {
    const double which = random.uniform(0, 1) * static_cast<double>(train.size());
    const Run& run = *train[static_cast<std::size_t>(which)];
    const double n = static_cast<double>(run.reference.size());
    const auto k = static_cast<std::size_t>(random.uniform(0.3, 0.7) * n);
    draw.event_run = run.number;
    draw.event_time = static_cast<double>(k) / kRate;
    if (std::abs(run.reference[k + 200] - run.reference[k]) > 0.06) return;  // 0.3 rad/s
  }
}

Draw draw_of(const Wish& wish, const CaseSpec& spec, const std::vector<Run>& runs,
             double peak_tau) {
  Random random(spec.seed, id_of(*wish.row));
  Draw draw;
  draw.size = wish.row->size * wish.m;
  draw.u = random.uniform(0, 1);
  draw.w = random.uniform(0, 1);
  place_event(random, runs, draw);
  draw.peak_tau = peak_tau;
  draw.seed = spec.seed;
  return draw;
}

/// Simulates runs of a case. What it hides may change from call to call.
class Laboratory {
 public:
  Laboratory(const CaseSpec& spec, const Bench& bench, const std::vector<Run>& runs)
      : spec_(spec), bench_(bench), runs_(runs) {}

  void set_peak(double tau) { peak_tau_ = tau; }

  Planted plant(const Wish& wish, const Run& run) const {
    return wish.row->make(draw_of(wish, spec_, runs_, peak_tau_), run, bench_);
  }

  /// Runs of the given roles; copy: with a noise of its own.
  std::vector<Recording> record(const std::vector<Wish>& wishes, double clutter, bool copy,
                                bool with_test) const {
    std::vector<Recording> out;
    for (Run run : runs_) {
      if (run.role == "test" && !with_test) continue;
      std::vector<Hooks> hooks;
      for (const Wish& wish : wishes) hooks.push_back(plant(wish, run).hooks);
      if (clutter > 0) {
        const Row& wander = row_of("wander.link");
        hooks.push_back(plant({&wander, clutter / wander.size}, run).hooks);
      }
      run.noise = 2 * spec_.seed + (copy ? 1 : 0);
      out.push_back(simulate(bench_, hooks, run));
    }
    return out;
  }

  const CaseSpec& spec() const { return spec_; }

 private:
  const CaseSpec& spec_;
  const Bench& bench_;
  const std::vector<Run>& runs_;
  double peak_tau_ = 50;
};

/// Rows of the runs that a model is fitted to.
Equations rows_of(const std::vector<Recording>& recordings, const std::vector<Run>& runs,
                  bool exact) {
  std::vector<Signals> chosen;
  std::size_t i = 0;
  for (const Run& run : runs) {
    if (i == recordings.size()) break;
    if (run.role != "test") chosen.push_back(exact ? recordings[i].exact : recordings[i].logged);
    if (run.role != "test" || recordings.size() == runs.size()) ++i;
  }
  return equations(chosen);
}

double peak_of(const std::vector<Recording>& recordings) {
  double peak = 0;
  for (const Recording& one : recordings)
    if (!one.exact.blocked)
      for (const double tau : one.exact.tau) peak = std::max(peak, std::abs(tau));
  return peak;
}

/// What an effect-free copy knows: the floor, and how to measure rho against it.
struct SimulatedCopy {
  const Laboratory& laboratory;
  const std::vector<Run>& runs;
  Equations exact;
  PerEquation floor;

  Rho rho(const std::vector<Recording>& recordings) const {
    return rho_of(rows_of(recordings, runs, true), exact, floor);
  }
  Rho rho(const std::vector<Wish>& wishes, double clutter) const {
    return rho(laboratory.record(wishes, clutter, false, false));
  }
};

/// The gap grows about as the square of the size, so a step of a secant in log-log mostly does;
/// where it leaves what is known to lie between too small and too large, the middle of that.
double size_for(double target, Wish wish, const SimulatedCopy& copy) {
  double small = 1e-4, large = 50;
  for (int i = 0; i < 14; ++i) {
    const double rho = copy.rho({wish}, 0).all;
    if (std::abs(rho - target) < 0.02 * (target - 1)) break;
    (rho < target ? small : large) = wish.m;
    const double step = std::sqrt((target - 1) / std::max(rho - 1, 1e-6));
    wish.m *= std::clamp(step, 0.1, 10.0);
    if (wish.m <= small || wish.m >= large) wish.m = std::sqrt(small * large);
  }
  return wish.m;
}

}  // namespace

const std::vector<Design>& designs() {
  static const std::vector<Design> rows{
      {"full", "slow and fast + dither, loads +30, -40, 0 N m, blocked sweep, 20 s each", full},
      {"short", "full, 6 s each", brief},
      {"one_load", "slow and fast + dither at +30 N m, no blocked sweep", one_load},
      {"preloads", "the same cables with l_o = 0 and 5.12 mrad", preloads},
  };
  return rows;
}

const Design& design_of(std::string_view name) {
  std::string known;
  for (const Design& design : designs()) {
    if (design.name == name) return design;
    known += ' ' + std::string(design.name);
  }
  throw std::invalid_argument("no design '" + std::string(name) + "'; there are:" + known);
}

Case make_case(const CaseSpec& spec) {
  Case out;
  out.spec = spec;
  out.bench.rig = rig_of_seed(spec.seed);
  out.bench.slow_noise_tau = spec.slow_noise;
  if (spec.poor_sensors) {
    out.bench.quantum_q = out.bench.quantum_theta = 2 * std::numbers::pi / std::exp2(14);
    out.bench.noise_tau = 1;
  }
  out.runs = design_of(spec.design).runs(spec.seed, out.bench);
  if (spec.extra) out.runs.push_back(extra_run(spec, out.bench, out.runs));

  Laboratory laboratory(spec, out.bench, out.runs);
  const auto copy_runs = laboratory.record({}, 0, true, false);
  laboratory.set_peak(peak_of(copy_runs));
  const SimulatedCopy copy{laboratory, out.runs, rows_of(copy_runs, out.runs, true),
                           floor_of(rows_of(copy_runs, out.runs, false))};
  out.floor = copy.floor;

  std::vector<Wish>& wishes = out.spec.effects;
  if (spec.rho)
    for (Wish& wish : wishes) wish.m = size_for(*spec.rho, wish, copy);
  out.recordings = laboratory.record(wishes, spec.clutter, false, true);
  out.rho = copy.rho(out.recordings);
  if (spec.clutter > 0) out.background = copy.rho({}, spec.clutter);
  const bool alone = wishes.size() == 1 && spec.clutter == 0;
  for (const Wish& wish : wishes)
    out.effects.push_back({wish.row, wish.m, laboratory.plant(wish, out.runs[0]).coefficients,
                           alone ? out.rho : copy.rho({wish}, 0)});
  return out;
}

}  // namespace hidden
