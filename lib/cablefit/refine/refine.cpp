#include "cablefit/refine/refine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "cablefit/base/error.hpp"
#include "cablefit/base/parallel.hpp"
#include "cablefit/refine/confirm.hpp"
#include "cablefit/refine/elastic_stage.hpp"
#include "cablefit/refine/levels.hpp"
#include "cablefit/refine/next_run.hpp"
#include "cablefit/refine/null_draws.hpp"
#include "cablefit/refine/refine_figures.hpp"
#include "cablefit/refine/refined_model.hpp"
#include "cablefit/refine/regimes.hpp"
#include "cablefit/refine/remainder.hpp"
#include "cablefit/refine/search.hpp"
#include "cablefit/refine/separability.hpp"
#include "cablefit/refine/unexplained.hpp"
#include "cablefit/refine/verdict.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kFloorDraws = 4;  // the floor is then known to about 1 %
// Tensions and stiffness that columns are made of were those of a model without the effect.
constexpr int kRelinearisations = 3;
constexpr double kHeldOutShare = 1.0 / 3;

/// What every step needs.
struct Bench {
  const RefineOptions& options;
  PartFilter wanted = {};
  bool elastic_only = false;
  ScanSettings scan = {};
  std::vector<LogSurvey> all = {};     ///< blocked, training, test: by Stretch::log
  std::vector<LogSurvey> logs = {};    ///< blocked, then training
  std::vector<LogSurvey> unseen = {};  ///< simulated for the last word; the training logs when none
  Smoothing smoothing = {};
  KindLevels floor{}, test_floor{};
  SimulatedGap simulation_floor = {};
  std::optional<NullBench> null = {};
  std::vector<NullDraw> draws = {};  ///< of searches; none until something is worth them
  Search first_search = {};          ///< on the base alone
};

/// Where the workflow stands.
struct State {
  Design design, test;  ///< training and unseen rows, with the same columns
  Eigen::VectorXd x;
  KindLevels levels{};
  double rho = 0;  ///< training rows
  RowGap unseen;
  SimulatedGap simulated;
};

void tell(const RefineOptions& options, std::string_view what, double share) {
  if (options.progress) options.progress(what, share);
}

template <typename Draw>
auto run_draws(const Bench& bench, std::size_t n, std::uint64_t first, std::string_view what,
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
        tell(bench.options, what, static_cast<double>(draws.size()) / static_cast<double>(n));
      });
  return draws;
}

/// The floor of the motor rows is the unit of gaps over all equations; of blocked logs alone
/// theirs.
KindLevels common_unit(const Bench& bench, KindLevels floor) {
  if (bench.elastic_only)
    floor[static_cast<std::size_t>(RowKind::motor)] =
        floor[static_cast<std::size_t>(RowKind::blocked)];
  return floor;
}

KindLevels fitted_floor(const Bench& bench) {
  std::vector<KindLevels> levels;
  for (const NullDraw& draw :
       run_draws(bench, kFloorDraws, bench.options.seed, "noise floor",
                 [&](std::uint64_t seed) { return bench.null->base_only(seed, nullptr); }))
    levels.push_back(draw.floor);
  return common_unit(bench, positive(rms_over(levels)));
}

/// Floors of the unseen logs: equations, and simulation beside what it was simulated from.
void find_unseen_floors(Bench& bench, const std::vector<Model>& models, const RefineLogs& logs) {
  bench.unseen = logs.test.empty() ? logs.train : logs.test;
  const NullBench unseen(models, bench.unseen, bench.wanted, bench.smoothing);
  bench.test_floor = logs.test.empty()
                         ? bench.floor
                         : positive(rms_over(run_draws(
                               bench, kFloorDraws, bench.options.seed, "noise floor",
                               [&](std::uint64_t seed) { return unseen.unfitted(seed); })));
  std::vector<LogSurvey> recorded;
  for (NullBench::Recorded& one : unseen.record(bench.options.seed))
    recorded.insert(recorded.end(), one.logs.begin(), one.logs.end());
  bench.simulation_floor = simulated_gap(models, recorded, bench.options.threads);
}

/// Gives the draws of the null what even the best candidate leaves, so that they look like the logs
/// would without it.
void disturb_null(Bench& bench, const State& state, const Search& found) {
  const Candidate* best = best_lasting(found.candidates);
  Design design = state.design;
  Eigen::VectorXd x = found.fit.x;
  if (best != nullptr) {
    design = with_variant(design, best->variant, x);
    x = best->x;
  }
  const TwinDisturbance wanted = remainder_of(design, x, bench.floor);
  if (is_quiet(wanted)) return;
  bench.null->disturb(wanted);
  // The rows see the disturbance through their kernel, which its colour has been through already.
  const KindLevels seen = bench.null->base_only(bench.options.seed, nullptr).floor;
  const KindLevels left = best != nullptr ? best->rms : found.fit.rms();
  KindLevels factors{1, 1, 1};
  for (std::size_t k = 0; k < kRowKinds; ++k) {
    const double floor = bench.floor[k] * bench.floor[k];
    const double ratio = (left[k] * left[k] - floor) / std::max(1e-12, seen[k] * seen[k] - floor);
    factors[k] = std::sqrt(std::clamp(ratio, 0.1, 10.0));
  }
  bench.null->disturb(scaled(wanted, common_unit(bench, factors)));
}

/// Simulated data sets are searched only once something is worth it.
void need_draws(Bench& bench, const State& state, const Search& found) {
  if (!bench.draws.empty() || !anything_material(found.candidates, bench.options)) return;
  disturb_null(bench, state, found);
  ScanSettings settings = bench.scan;
  settings.threads = 1;
  bench.draws = run_draws(
      bench, bench.options.n_draws, bench.options.seed + kFloorDraws, "chance",
      [&](std::uint64_t seed) { return bench.null->searched(seed, bench.floor, settings); });
}

/// The state with one more effect; nothing when the rows become singular.
std::optional<State> with_candidate(const Bench& bench, const State& state, const Search& found,
                                    const Candidate& winner) {
  if (!applies(state.design, winner.variant)) return {};
  State next;
  next.design = with_variant(state.design, winner.variant, found.fit.x);
  next.test = with_variant(state.test, winner.variant, found.fit.x);
  next.levels = found.levels;
  std::optional<BlockFit> fit;
  for (int round = 0; round < kRelinearisations; ++round) {
    if (round > 0) {
      next.design = relinearised(next.design, fit->x);
      next.test = relinearised(next.test, fit->x);
    }
    fit = fit_blocks(block_grams(next.design.rows, next.design.stretches, bench.scan.block_seconds),
                     next.levels, false);
    if (!fit) return {};
  }
  next.x = fit->x;
  next.rho = rho_of(*fit, bench.floor);
  next.unseen = gap_of(next.test, next.x, bench.test_floor, bench.scan.block_seconds);
  next.simulated =
      simulated_gap(models_with(next.design, next.x), bench.unseen, bench.options.threads);
  return next;
}

RefineEvidence evidence_of(const Bench& bench, const State& before, const State& after,
                           const Judgement& judgement) {
  RefineEvidence e;
  e.rho_before = before.rho;
  e.rho_after = after.rho;
  e.p_value = judgement.p_value;
  e.inclusion = judgement.inclusion;
  e.n_draws = bench.draws.size();
  // On rows that had no say; on the training rows where those show no gap to close.
  const bool visible = before.unseen.rho > kVisibleGap;
  const double from = visible ? before.unseen.rho : before.rho;
  const double to = visible ? after.unseen.rho : after.rho;
  e.gain = from > 1 ? (from - to) / (from - 1) : 0;
  return e;
}

/// What a search names, added on trial.
struct Trial {
  Judgement judgement;
  Candidate winner;
  State after;
};

/// Nothing: nothing is named.
std::optional<Trial> try_next(Bench& bench, const State& state, bool is_first,
                              RefineResult* first_result) {
  tell(bench.options, "search", 0);
  const Search found = search(state.design, bench.floor, bench.scan);
  need_draws(bench, state, found);
  const SquaredGap gap{found.fit.held_out.sum(), floor_error(found.fit, bench.floor, found.levels)};
  Trial trial;
  trial.judgement = judge_search(found.candidates, gap, bench.draws, bench.options, is_first);
  if (first_result != nullptr) {
    first_result->league = trial.judgement.league;
    bench.first_search = found;
  }
  if (!trial.judgement.is_named) return {};
  trial.winner = refined_shape({state.design, found.grams, found.fit, found.levels}, bench.scan,
                               *trial.judgement.best);
  trial.judgement.best = nullptr;  // of the search, which ends here
  auto next = with_candidate(bench, state, found, trial.winner);
  if (!next) return {};
  trial.after = std::move(*next);
  return trial;
}

/// `reason`: of a refusal.
RefineStep step_of(const Bench& bench, const Trial& trial, const std::string& reason) {
  const Refinement& row = *trial.winner.variant.refinement;
  const double unit = bench.floor[static_cast<std::size_t>(RowKind::motor)];
  RefineStep step;
  step.added = row.name;
  step.side = to_string(row.site);
  step.gap_train = unit * std::sqrt(trial.after.rho);
  step.gap_test = unit * std::sqrt(trial.after.unseen.rho);
  step.reason = reason;
  step.accepted = reason.empty();
  return step;
}

UnseenChange change_of(const Bench& bench, const Refinement& row, const State& before,
                       const State& after) {
  return {row,
          before.unseen.rho,
          after.unseen.rho,
          before.simulated,
          after.simulated,
          bench.simulation_floor};
}

NamedEffect effect_of(const Bench& bench, const State& before, const State& after,
                      const Judgement& judgement) {
  NamedEffect effect;
  effect.evidence = evidence_of(bench, before, after, judgement);
  effect.rivals = judgement.rivals;
  return effect;
}

/// What was refused alone may be half of the truth: with the next best beside it, both are judged
/// together. Two names at once need more evidence than one.
bool add_both(Bench& bench, State& state, const Trial& one, RefineResult& result) {
  auto two = try_next(bench, one.after, false, nullptr);
  if (!two) return false;
  const UnseenChange change = change_of(bench, *two->winner.variant.refinement, state, two->after);
  const std::string reason = why_not_both(change);
  result.steps.push_back(step_of(bench, *two, reason));
  if (!reason.empty()) return false;
  for (RefineStep& step : result.steps) step.accepted = true;
  result.effects.push_back(effect_of(bench, state, one.after, one.judgement));
  result.effects.push_back(effect_of(bench, one.after, two->after, two->judgement));
  state = std::move(two->after);
  return true;
}

/// One round: search, judge, confirm, add. False: nothing was added.
bool add_next_effect(Bench& bench, State& state, RefineResult& result) {
  const bool is_first = result.effects.empty();
  auto trial = try_next(bench, state, is_first, is_first ? &result : nullptr);
  if (!trial) return false;
  const Refinement& row = *trial->winner.variant.refinement;
  const std::string reason = why_not_added(change_of(bench, row, state, trial->after));
  result.steps.push_back(step_of(bench, *trial, reason));
  if (!reason.empty()) return is_first && add_both(bench, state, *trial, result);
  result.effects.push_back(effect_of(bench, state, trial->after, trial->judgement));
  state = std::move(trial->after);
  return true;
}

/// The first of two was named while the second was missing: named again beside it, it may be
/// another.
void name_first_again(Bench& bench, const State& first, State& state, RefineResult& result) {
  Search found;
  found.levels = state.levels;
  found.fit.x = first.x;
  Candidate second;
  second.variant = state.design.added[1];
  const auto alone = with_candidate(bench, first, found, second);
  if (!alone) return;
  const auto trial = try_next(bench, *alone, false, nullptr);
  if (!trial) return;
  const Refinement& row = *trial->winner.variant.refinement;
  NamedEffect& named = result.effects.front();
  if (&row == state.design.added.front().refinement) {
    named.rivals = trial->judgement.rivals;  // fewer: the second no longer blurs it
    return;
  }
  // A tie goes to what is named beside the other.
  constexpr double kTie = 1.01;
  if (trial->after.rho > kTie * state.rho || trial->after.unseen.rho > kTie * state.unseen.rho ||
      !why_not_added(change_of(bench, row, *alone, trial->after)).empty())
    return;
  result.steps.front() = step_of(bench, *trial, "");
  named = effect_of(bench, first, trial->after, trial->judgement);
  State other = trial->after;
  std::swap(result.effects[0], result.effects[1]);  // in the order of the design
  std::swap(result.steps[0], result.steps[1]);
  state = std::move(other);
}

/// Two effects together may look like a third, and what is best alone is then neither. Where two
/// leave something, other beginnings are tried: each with what is best beside it.
void begin_otherwise(Bench& bench, const State& first, State& state, RefineResult& result) {
  constexpr std::size_t kBeginnings = 3;
  const Search& found = bench.first_search;
  const Refinement& taken = *state.design.added.front().refinement;
  for (const Candidate* candidate : best_candidates(found.candidates, kBeginnings, taken)) {
    Trial one;
    one.winner =
        refined_shape({first.design, found.grams, found.fit, found.levels}, bench.scan, *candidate);
    auto after = with_candidate(bench, first, found, one.winner);
    if (!after) continue;
    one.after = std::move(*after);
    auto two = try_next(bench, one.after, false, nullptr);
    if (!two || two->after.rho >= state.rho || two->after.unseen.rho >= state.unseen.rho) continue;
    const Refinement& row = *two->winner.variant.refinement;
    if (!why_not_added(change_of(bench, row, first, two->after)).empty()) continue;
    // Named beside each other, none alone.
    const double p_value = result.effects.front().evidence.p_value;
    one.judgement.p_value = p_value;
    one.judgement.inclusion = result.effects.front().evidence.inclusion;
    result.effects = {effect_of(bench, first, one.after, one.judgement),
                      effect_of(bench, one.after, two->after, two->judgement)};
    result.steps = {step_of(bench, one, ""), step_of(bench, *two, "")};
    state = std::move(two->after);
  }
}

/// Torques of rows weighted so that every equation has the motor's floor.
void tell_gaps(const Bench& bench, const State& first, const State& last, RefineResult& result) {
  const double unit = bench.floor[static_cast<std::size_t>(RowKind::motor)];
  GapStory& torque = result.torque;
  torque.known = true;
  torque.noise_floor = unit;
  torque.train_before = unit * std::sqrt(first.rho);
  torque.train_after = unit * std::sqrt(last.rho);
  torque.test_before = unit * std::sqrt(first.unseen.rho);
  torque.test_after = unit * std::sqrt(last.unseen.rho);
  for (std::size_t i = 0; i < 2; ++i) {
    const double level = i == 0 ? 0.025 : 0.975;
    torque.test_before_ci[i] = unit * std::sqrt(first.unseen.quantile(level));
    torque.test_after_ci[i] = unit * std::sqrt(last.unseen.quantile(level));
  }
  GapStory& simulation = result.simulation;
  simulation.known = first.simulated.known() && last.simulated.known();
  simulation.test_before = first.simulated.deflection;
  simulation.test_after = last.simulated.deflection;
  simulation.noise_floor = bench.simulation_floor.deflection;
  for (const SimulatedGap* gap : {&first.simulated, &last.simulated})
    if (!gap->known() && !bench.elastic_only)
      result.warnings.push_back("not simulated: " + gap->failure);
  if (first.simulated.failure == last.simulated.failure && !result.warnings.empty() &&
      !simulation.known && !bench.elastic_only)
    result.warnings.pop_back();
}

void tell_remainder(const KindLevels& rms, const KindLevels& floor, RefineResult& result) {
  const auto above = [&](RowKind kind) {
    const auto k = static_cast<std::size_t>(kind);
    return std::sqrt(std::max(0.0, rms[k] * rms[k] - floor[k] * floor[k]));
  };
  result.remainder_blocked = above(RowKind::blocked);
  const auto blocked = static_cast<std::size_t>(RowKind::blocked);
  result.floor_blocked = rms[blocked] > 0 ? floor[blocked] : 0;  // 0: there are no such rows
  if (result.elastic_only) return;
  result.remainder_motor = above(RowKind::motor);
  result.floor_motor = floor[static_cast<std::size_t>(RowKind::motor)];
  if (result.rigid) return;
  result.remainder_link = above(RowKind::link);
  result.floor_link = floor[static_cast<std::size_t>(RowKind::link)];
}

void tell_inputs(std::span<const Model> models, const RefineLogs& logs, RefineResult& result) {
  for (const auto* some : {&logs.blocked, &logs.train, &logs.test})
    for (const LogSurvey& log : *some)
      result.inputs.push_back({log.plan.path, log.sha256, log.n_rows});
  for (const Model& model : models) result.preloads.push_back(model.preload);
  result.rigid = models.front().rigid;
  result.linear_motion = models.front().rig.linear_motion;
  result.rig_path = models.front().rig.path;
}

/// Kernels that suit all logs.
Smoothing smoothing_of(const Bench& bench, std::span<const Model> models,
                       const std::vector<Stretch>& train, const std::vector<Stretch>& test) {
  if (!bench.elastic_only) return smoothing_for(train.front().recording.period);
  std::vector<Stretch> all = train;
  all.insert(all.end(), test.begin(), test.end());
  return blocked_smoothing(models, all);
}

/// The base fit, floors and unseen rows.
State prepare(Bench& bench, std::span<const Model> models, const RefineLogs& logs,
              RefineResult& result) {
  std::vector<Stretch> train = read_stretches(bench.logs, models, bench.wanted);
  if (train.empty())
    throw input_error({}, "no stretch of evenly spaced rows is long enough to refine with",
                      "give logs of at least a few seconds with --train");
  std::vector<Stretch> test = read_stretches(logs.test, models, bench.wanted);
  for (Stretch& stretch : test) stretch.log += bench.logs.size();  // recorded after what they test
  const Smoothing wanted = smoothing_of(bench, models, train, test);
  if (bench.elastic_only && !test.empty() &&
      !has_rows({models.begin(), models.end()}, test, wanted)) {
    result.warnings.emplace_back(
        "the test logs do not move enough to judge by; the last third of the others is held out");
    test.clear();
  }
  result.held_out_blocks = test.empty();
  if (test.empty())
    test = bench.elastic_only ? hold_out_blocked(train, kHeldOutShare)
                              : hold_out(train, kHeldOutShare);
  const std::vector<Model> bases = bench.elastic_only
                                       ? with_visible_effects({models.begin(), models.end()}, train,
                                                              wanted, bench.scan.block_seconds)
                                       : std::vector<Model>(models.begin(), models.end());
  BaseFit base =
      fit_base(make_design(bases, std::move(train), wanted), bench.scan.block_seconds, nullptr);
  bench.smoothing = base.design.smoothing;
  std::vector<Model> fitted = models_with(base.design, base.fit.x);
  bench.null.emplace(fitted, bench.logs, bench.wanted, bench.smoothing);
  bench.floor = fitted_floor(bench);
  base = fit_base(std::move(base.design), bench.scan.block_seconds, &bench.floor);
  fitted = models_with(base.design, base.fit.x);
  find_unseen_floors(bench, fitted,
                     result.held_out_blocks ? RefineLogs{logs.train, {}, logs.blocked} : logs);
  State state;
  state.test = make_design(fitted, std::move(test), bench.smoothing);
  state.x = base.fit.x;
  state.levels = bench.floor;
  state.rho = rho_of(base.fit, bench.floor);
  state.unseen = gap_of(state.test, state.x, bench.test_floor, bench.scan.block_seconds);
  state.simulated = simulated_gap(fitted, bench.unseen, bench.options.threads);
  state.design = std::move(base.design);
  return state;
}

}  // namespace

std::string_view to_string(Verdict verdict) {
  constexpr std::array<std::string_view, 4> kNames{"named", "none", "ambiguous", "unexplained"};
  return kNames[static_cast<std::size_t>(verdict)];
}

RefineResult refine(std::span<const Model> given, const RefineLogs& logs,
                    const RefineOptions& options) {
  RefineResult result;
  const RefineStage stage = stage_of(given, logs);
  const std::span<const Model> models = stage.models;
  tell_inputs(models, logs, result);
  result.elastic_only = stage.elastic_only;
  result.warnings = stage.warnings;
  Bench bench{options, stage.wanted, stage.elastic_only};
  bench.scan.threads = options.threads;
  bench.logs = logs.blocked;
  bench.logs.insert(bench.logs.end(), logs.train.begin(), logs.train.end());
  bench.all = bench.logs;
  bench.all.insert(bench.all.end(), logs.test.begin(), logs.test.end());
  const State first = prepare(bench, models, logs, result);
  const BaseFit noise = bench.null->fitted(options.seed, bench.floor);
  result.where = ranked(find_regimes(first.design, first.x, bench.floor),
                        find_bands(first.design, first.x, noise.design, noise.fit.x), first.design,
                        first.x, bench.floor);
  const std::vector<TrialRun> runs = trial_runs(first.design);
  tell(options, "what can be told apart", 0);
  result.not_separable = find_not_separable(first.design, first.x, bench.floor, runs);

  State state = first;
  while (result.effects.size() < options.most_effects && add_next_effect(bench, state, result)) {
    if (result.effects.size() == 2) {
      name_first_again(bench, first, state, result);
      if (state.rho >= kNoGap) {
        begin_otherwise(bench, first, state, result);
        name_first_again(bench, first, state, result);
      }
    }
    if (state.rho < kNoGap) break;
  }

  const FinalFit fit =
      final_fit(first.design, state.design, state.levels, bench.scan.block_seconds);
  const std::vector<NamedEffect> named = named_effects(state.design, fit);
  for (std::size_t k = 0; k < named.size(); ++k) {
    result.effects[k].instance = named[k].instance;
    result.effects[k].derived = named[k].derived;
    result.effects[k].torque_rms = named[k].torque_rms;
  }
  result.shifts = parameter_shifts(first.design, first.x, state.design, fit);
  result.models = refined_models(state.design, fit);
  result.rho_before = first.rho;
  result.rho_after = state.rho;
  tell_gaps(bench, first, state, result);
  tell_remainder(fit.rms, bench.floor, result);
  if (state.rho > kRemainder)
    result.unexplained =
        describe_remainder(state.design, fit.x, bench.floor, bench.scan.block_seconds);
  conclude(result);
  choose_next_run({first.design, first.x, bench.floor, bench.first_search.candidates, runs},
                  result);
  if (options.figures)
    result.figures =
        refine_figures(result, {bench.all, first.design, first.x, state.design, fit.x},
                       {bench.all, first.test, first.x, state.test, fit.x}, bench.floor);
  return result;
}

}  // namespace cablefit
