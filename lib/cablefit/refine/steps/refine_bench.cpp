#include "cablefit/refine/steps/refine_bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "cablefit/base/error.hpp"
#include "cablefit/base/parallel.hpp"
#include "cablefit/refine/gap_levels.hpp"
#include "cablefit/refine/null/chance_tail.hpp"
#include "cablefit/refine/null/kept_effects.hpp"
#include "cablefit/refine/null/logs_seed.hpp"
#include "cablefit/refine/null/remainder.hpp"
#include "cablefit/refine/rows/physical_values.hpp"
#include "cablefit/refine/rows/recorded_effects.hpp"
#include "cablefit/refine/steps/determined_effects.hpp"
#include "cablefit/refine/steps/elastic_stage.hpp"
#include "cablefit/refine/steps/fit_bias.hpp"
#include "cablefit/refine/verdict/conclusion.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kFloorCopies = 4;  // the floor is then known to about 1 %

template <typename Draw>
auto run_draws(const RefineBench& bench, std::size_t n, std::uint64_t first, std::string_view what,
               Draw draw) {
  std::vector<decltype(draw(first))> draws;
  ordered_pipeline<std::uint64_t>(
      bench.options.threads,
      [&](auto emit) {
        for (std::size_t k = 0; k < n; ++k) emit(std::uint64_t{first + k});
      },
      draw,
      [&](auto one) {
        draws.push_back(std::move(one));
        report_progress(bench.options, what,
                        static_cast<double>(draws.size()) / static_cast<double>(n));
      });
  return draws;
}

/// The floor of the motor rows is the unit of gaps over all equations; of blocked logs alone
/// theirs.
KindLevels common_unit(const RefineBench& bench, KindLevels floor) {
  if (bench.elastic_only)
    floor[static_cast<std::size_t>(RowKind::motor)] =
        floor[static_cast<std::size_t>(RowKind::blocked)];
  return floor;
}

/// Of rows that the test logs have none of: the training rows'.
KindLevels test_floor_of(const RefineBench& bench, KindLevels floor) {
  floor = common_unit(bench, floor);
  for (std::size_t k = 0; k < kRowKinds; ++k)
    if (!(floor[k] > 0)) floor[k] = bench.floor[k];
  return floor;
}

/// `base`, `x`: the fit that the draws are simulated from.
KindLevels fitted_floor(RefineBench& bench, const Design& base, const Eigen::VectorXd& x) {
  std::vector<KindLevels> levels;
  Eigen::VectorXd bias = Eigen::VectorXd::Zero(x.size());
  std::vector<BaseFit> draws =
      run_draws(bench, kFloorCopies, bench.seed, "noise floor",
                [&](std::uint64_t seed) { return bench.null->fitted(seed, nullptr); });
  for (const BaseFit& draw : draws) {
    levels.push_back(draw.fit.rms());
    bias += (draw.fit.x - x) / static_cast<double>(kFloorCopies);
  }
  const KindLevels draw_floor = positive(rms_over(levels));
  double held_out = 0;
  for (const BaseFit& draw : draws)
    held_out +=
        held_out_gap(draw.grams, draw.levels, draw_floor).rho / static_cast<double>(kFloorCopies);
  if (held_out > 1) bench.held_out_unit = held_out;
  forget_unrecorded(base, bias);
  bench.base_bias.x = std::move(bias);
  bench.noise = std::move(draws.front());
  KindLevels floor = rms_over(levels);
  // Of rows that there are none of: simulated runs may have some.
  auto& blocked = floor[static_cast<std::size_t>(RowKind::blocked)];
  if (!(blocked > 0)) blocked = floor[static_cast<std::size_t>(RowKind::motor)];
  return common_unit(bench, positive(floor));
}

/// Floors of the test logs: equations, and simulation beside what it was simulated from.
void find_test_floors(RefineBench& bench, const BaseFit& base, const RefineLogs& logs) {
  bench.test_logs = logs.test.empty() ? logs.train : logs.test;
  const BaseDraws draws(base.design, base.fit.x, bench.test_logs, bench.wanted,
                        bench.options.threads);
  bench.test_floor =
      logs.test.empty()
          ? bench.floor
          : test_floor_of(bench, rms_over(run_draws(
                                     bench, kFloorCopies, bench.seed, "noise floor",
                                     [&](std::uint64_t seed) { return draws.unfitted(seed); })));
  std::vector<LogSurvey> recorded;
  for (NullBench::Recorded& one : draws.logs().record(bench.seed, bench.options.threads))
    recorded.insert(recorded.end(), one.logs.begin(), one.logs.end());
  bench.simulation_floor =
      simulated_gap(draws.models(), recorded, bench.options.threads, bench.compared());
}

/// What rows remember of what the best candidate leaves; of a draw, which has no such effect, all
/// the same with its columns.
KindMemory memory_with(const Design& design, const BlockFit& fit, const Candidate* best,
                       const KindLevels& levels, double block_seconds) {
  if (best == nullptr || !applies(design, best->variant)) return memory_of(design, fit.x);
  const Design with = with_variant(design, best->variant, fit.x);
  const auto both =
      fit_blocks(block_grams(with.rows, with.stretches, block_seconds), levels, false);
  return both ? memory_of(with, both->x) : memory_of(design, fit.x);
}

/// The candidate whose residual is that of the logs. Some event explains a little of any
/// low-frequency disturbance. So an event counts only where it explains most of a gap, and more
/// than any effect that is no event.
const Candidate* best_explaining(const Search& found, const KindLevels& floor) {
  constexpr double kMost = 0.5;
  const Candidate* best = best_lasting(found.candidates);
  const double total = found.fit.held_out.sum(),
               noise = floor_error(found.fit, floor, found.levels);
  if (total < kRemainder * noise) return best;
  for (const Candidate& c : found.candidates) {
    const bool most = c.refused.empty() && c.gain * total > kMost * (total - noise);
    if (most && c.variant.effect->is_event && (best == nullptr || c.gain > best->gain)) best = &c;
  }
  return best;
}

/// Gives the draws of the null what even the best candidate leaves, so that they look like the logs
/// would without it.
void disturb_null(RefineBench& bench, const RefineState& state, const Search& found) {
  const Candidate* best = best_explaining(found, bench.floor);
  const double block_seconds = bench.scan.block_seconds;
  const KindMemory left = memory_with(state.design, found.fit, best, found.levels, block_seconds);
  const KindMemory guess = remainder_of(left, bench.floor);
  const CopyDisturbance first = as_disturbance(guess, !bench.elastic_only);
  if (is_quiet(first)) return;
  bench.null->logs().disturb(first);
  const std::vector<KindMemory> drawn =
      run_draws(bench, kFloorCopies, bench.seed, "the remainder", [&](std::uint64_t seed) {
        const BaseFit base = bench.null->fitted(seed, &found.levels);
        return memory_with(base.design, base.fit, best, found.levels, block_seconds);
      });
  bench.null->logs().disturb(
      as_disturbance(corrected(guess, left, mean_of(drawn)), !bench.elastic_only));
}

/// A parameter that only one block determines cannot be confirmed by the others: the block is not
/// used to judge.
void check_blocks(const BaseFit& base, double block_seconds, RefineResult& result) {
  const Eigen::Index alone = base.fit.alone.count();
  if (alone == 0) return;
  const Eigen::Index judging = (base.fit.held_out > 0).count();
  if (judging == 0)
    throw Error(ErrorKind::not_identifiable,
                fmt::format("one block of {:g} s alone determines a parameter of the model, and "
                            "there is no other to judge by; record longer",
                            block_seconds));
  result.warnings.push_back(
      fmt::format("{} of {} blocks of {:g} s alone determine a parameter of the model: they are "
                  "fitted, but not used in the evidence",
                  alone, alone + judging, block_seconds));
}

/// Kernels of the finest of the moving logs, which shake fastest; see suited.
Smoothing smoothing_of(const RefineBench& bench, std::span<const Model> models,
                       const std::vector<Stretch>& train, const std::vector<Stretch>& test) {
  if (!bench.elastic_only) return smoothing_for(finest_period(train, false));
  std::vector<Stretch> all = train;
  all.insert(all.end(), test.begin(), test.end());
  return blocked_smoothing(models, all);
}

/// Whether the test rows, judged by the least speeds of the training logs, have more rows than the
/// models have columns.
bool are_enough(std::span<const Model> models, const std::vector<Stretch>& train,
                const std::vector<Stretch>& test, const Smoothing& wanted) {
  if (test.empty()) return false;
  const Design design = make_design(models, test, make_design(models, train, wanted).smoothing);
  return count_rows(design.rows) > design.n_columns();
}

}  // namespace

void report_progress(const RefineOptions& options, std::string_view what, double share) {
  if (options.progress) options.progress(what, share);
}

SimulatedGap RefineBench::simulated(std::span<const Model> models) const {
  return simulated_gap(models, test_logs, options.threads, compared());
}

void judge(const RefineBench& bench, const BlockFit& fit, RefineState& state) {
  state.rho = rho_of(fit, bench.floor);
  state.held_out =
      held_out_gap(block_grams(state.design, bench.scan.block_seconds), state.levels, bench.floor);
  state.held_out.rho /= bench.held_out_unit;
  state.held_out.squares /= bench.held_out_unit;
}

bool draw_more(RefineBench& bench, const RefineState& state, const Search& found) {
  const std::size_t before = bench.draws.size();
  if (before >= bench.options.n_draws) return false;
  if (before == 0) {
    disturb_null(bench, state, found);
    bench.draw_levels = found.levels;
  }
  ScanSettings settings = bench.scan;
  settings.threads = 1;
  std::vector<NullDraw> more = run_draws(
      bench, std::min(kFirstDraws, bench.options.n_draws - before),
      bench.seed + kFloorCopies + before, "null distribution",
      [&](std::uint64_t seed) { return bench.null->searched(seed, bench.draw_levels, settings); });
  bench.draws.insert(bench.draws.end(), std::make_move_iterator(more.begin()),
                     std::make_move_iterator(more.end()));
  return true;
}

RefineState prepare(RefineBench& bench, std::span<const Model> models, const RefineLogs& logs,
                    RefineResult& result) {
  std::vector<Stretch> train = read_stretches(bench.logs, models, bench.wanted);
  if (train.empty() || (!bench.elastic_only && !std::isfinite(finest_period(train, false))))
    throw input_error({}, "no stretch of evenly spaced rows is long enough to refine with",
                      "give logs of at least a few seconds with --train");
  std::vector<Stretch> test = read_stretches(logs.test, models, bench.wanted);
  for (Stretch& stretch : test) stretch.log += bench.logs.size();  // recorded after what they test
  const Smoothing wanted = smoothing_of(bench, models, train, test);
  if (!logs.test.empty() && !are_enough(models, train, test, wanted)) {
    result.warnings.emplace_back(
        "the test logs move too little to be judged; the last third of the others is "
        "held out");
    test.clear();
  }
  result.held_out_blocks = test.empty();
  if (test.empty()) {
    test = hold_out(train, kHeldOutShare, bench.elastic_only ? HoldOut::all : HoldOut::moving);
    if (train.empty() || !are_enough(models, train, test, wanted))
      throw input_error({}, "the last third of the logs, held out, has too few rows to judge by",
                        logs.test.empty() ? "record longer, or give other logs with --test"
                                          : "record longer; the test logs are too short as well");
  }
  const std::vector<Model> bases =
      bench.elastic_only ? with_visible_effects({models.begin(), models.end()}, train, wanted,
                                                bench.scan.block_seconds)
                         : with_determined_effects({models.begin(), models.end()}, train, wanted,
                                                   bench.scan.block_seconds, result.warnings);
  KeptBase kept = fit_kept_base(bases, std::move(train), wanted, bench.scan);
  result.warnings.insert(result.warnings.end(), kept.warnings.begin(), kept.warnings.end());
  BaseFit base = std::move(kept.base);
  check_blocks(base, bench.scan.block_seconds, result);
  std::vector<Eigen::Index> held;
  const auto to_physical = [&] {
    base.fit.x =
        physical_values(base.design, bench.scan.block_seconds, base.levels, base.fit.x, &held);
  };
  to_physical();
  bench.seed = seed_for(bench.logs, bench.options.seed);
  bench.null.emplace(base.design, base.fit.x, bench.logs, bench.wanted, bench.options.threads);
  if (bench.null->logs().follows())
    result.warnings.emplace_back(
        "the controller with the reference of the logs does not reproduce the measured "
        "motion (is a feed-forward torque or a delay missing in it?); p-values use "
        "simulations that follow the measured motion");
  bench.held_back = result.held_out_blocks ? kHeldOutShare : 0;
  bench.null->logs().hold_back(bench.held_back);
  bench.floor = fitted_floor(bench, base.design, base.fit.x);
  base = fit_base(std::move(base.design), bench.scan.block_seconds, &bench.floor);
  to_physical();
  for (const Eigen::Index column : held)
    result.warnings.push_back(fmt::format(
        "the fitted {} of the base model is not physical (negative); simulations use {:.3g}",
        base.design.layout.parameters[static_cast<std::size_t>(column)].name, base.fit.x(column)));
  bench.test = std::move(test);
  find_test_floors(bench, base,
                   result.held_out_blocks ? RefineLogs{logs.train, {}, logs.blocked} : logs);
  RefineState state;
  bench.n_kept = base.design.added.size();
  if (bench.n_kept > 0) bench.bare = relinearised(kept.bare, base.fit.x);
  state.x = base.fit.x;
  state.levels = bench.floor;
  state.design = std::move(base.design);
  judge(bench, base.fit, state);
  if (!free_shapes(state.design).empty())  // of kept effects, which the draws above hold
    if (auto bias = fit_bias(bench, state)) bench.base_bias = std::move(*bias);
  return state;
}

}  // namespace cablefit
