#include "cablefit/refine/effect_steps.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "cablefit/estimate/tail_probability.hpp"
#include "cablefit/refine/conclusion.hpp"
#include "cablefit/refine/effect_trial.hpp"
#include "cablefit/refine/fit_bias.hpp"
#include "cablefit/refine/refined_model.hpp"
#include "cablefit/refine/verdict.hpp"
#include "cablefit/refine/whitened_look.hpp"

namespace cablefit {
namespace {

RefineEvidence evidence_of(const RefineBench& bench, const RefineState& before,
                           const RefineState& after, const Judgement& judgement) {
  RefineEvidence e;
  e.rho_before = before.rho;
  e.rho_after = after.rho;
  e.p_value = judgement.chance.p;
  e.is_fitted_tail = judgement.chance.is_fitted;
  e.inclusion = judgement.inclusion;
  e.n_draws = bench.draws_of(before.design).size();
  // On rows that had no say; on the training rows where those show no gap to close.
  const bool visible = before.unseen.rho > kVisibleGap;
  const double from = visible ? before.unseen.rho : before.rho;
  const double to = visible ? after.unseen.rho : after.rho;
  e.gain = from > 1 ? (from - to) / (from - 1) : 0;
  return e;
}

/// `reason`: of a refusal.
RefineStep step_of(const RefineBench& bench, const Trial& trial, const std::string& reason) {
  const Refinement& row = *trial.winner.variant.refinement;
  RefineStep step;
  step.added = row.name;
  step.side = to_string(row.site);
  step.gap_train = bench.unit() * std::sqrt(trial.after.rho);
  step.gap_test = bench.unseen_unit() * std::sqrt(trial.after.unseen.rho);
  step.reason = reason;
  step.accepted = reason.empty();
  return step;
}

/// How much better the unseen rows fit, in sd over their blocks, weighted as the search was.
double sd_better(const RefineBench& bench, const RefineState& before, const RefineState& after) {
  const auto error = [&](const RefineState& state) {
    return gap_of(block_grams(state.test, bench.scan.block_seconds), state.x, after.levels).squares;
  };
  return paired(error(before), error(after)).in_sd();
}

/// Whether the unseen rows should show an event.
bool is_after_event(const RefineBench& bench, const Variant& variant) {
  const bool is_held_out = bench.held_back > 0;
  return variant.refinement->lasts() && (is_held_out || !variant.ends_with_log);
}

/// Of the last effect's coefficients, with the sandwich over the blocks, whose residuals may wander
/// (White 1980), and as few as there are (Hotelling 1931). 0 for what has none.
double chance_of_size(const RefineBench& bench, const RefineState& after) {
  const Eigen::Index n = n_linear(after.design.added.back());
  if (n == 0) return 0;
  const BlockGrams grams = block_grams(after.design, bench.scan.block_seconds);
  const auto fit = fit_blocks(grams, after.levels, false);
  const Eigen::Index blocks = count_blocks(grams);
  if (!fit || blocks <= n) return 1;
  const Eigen::VectorXd size = fit->x.tail(n);
  const Eigen::MatrixXd covariance = fit->covariance.bottomRightCorner(n, n);
  const auto p = static_cast<double>(n), b = static_cast<double>(blocks);
  const double squared = size.dot(covariance.ldlt().solve(size));
  return f_tail((b - p) / (p * b) * squared, p, b - p);
}

UnseenChange change_of(const RefineBench& bench, const Refinement& row, const RefineState& before,
                       const RefineState& after, const SimulatedGap& simulated_before,
                       const SimulatedGap& simulated_after) {
  return {row,
          before.unseen.rho,
          after.unseen.rho,
          simulated_before,
          simulated_after,
          bench.simulation_floor,
          after.rho > kRemainder,
          sd_better(bench, before, after),
          is_after_event(bench, after.design.added.back()),
          (before.rho - after.rho) / std::max(1e-9, before.rho - 1),
          after.rho > kRemainder ? chance_of_size(bench, after) : 0};
}

UnseenChange change_of(const RefineBench& bench, const Refinement& row, const RefineState& before,
                       const RefineState& after) {
  return change_of(bench, row, before, after, before.simulated, after.simulated);
}

/// Whether the rows fit as well with the last effect's coefficients at 0: what it stood for went
/// into what others follow from when all was fitted together.
bool carries_nothing(const RefineBench& bench, const RefineState& after) {
  constexpr double kNoLoss = 0.005;  // of the squared residual
  const Eigen::Index n = n_linear(after.design.added.back());
  if (n == 0) return false;
  Eigen::VectorXd without = after.x;
  without.tail(n).setZero();
  const double rho = gap_of(after.design, without, bench.floor, bench.scan.block_seconds).rho;
  return rho < (1 + kNoLoss) * after.rho;
}

/// Reason against a step; empty: none. Where the unseen equations are sure of it but the simulation
/// is not, the bias of either fit may hide what the effect is worth: the simulations without it
/// decide. Unseen equations below their floor, which is that of values without bias, are judged
/// without it as well.
std::string why_not(const RefineBench& bench, const Refinement& row, const RefineState& before,
                    const RefineState& after, bool is_first) {
  const bool is_white = before.design.whitening.is_needed();
  // Of whitened rows a test of its size tells more.
  if (!is_white && carries_nothing(bench, after))
    return "it carries nothing once all is fitted with it";
  const UnseenChange change = change_of(bench, row, before, after);
  std::string reason = why_not_added(change);
  const bool both_known = change.before.known() && change.after.known();
  const bool is_sure = change.sd_better >= kClearlyBetter;
  const bool is_below_floor = change.rho_before < 1 && !change.leaves_remainder;
  if (reason.empty() || !both_known || !(is_sure || is_below_floor)) return reason;
  const auto bias =
      is_first && !is_white ? std::optional(bench.base_bias) : fit_bias(bench, before);
  const auto bias_after = fit_bias(bench, after);
  if (is_sure) {
    SimulatedGap best = simulated_best(bench, before, bias);
    if (before.simulated_before)
      best = smaller(best, *before.simulated_before, bench.simulation_floor);
    return why_not_added(
        change_of(bench, row, before, after, best, simulated_best(bench, after, bias_after)));
  }
  if (!bias || !bias_after) return reason;
  return why_not_added(change_of(bench, row, without_bias(bench, before, *bias),
                                 without_bias(bench, after, *bias_after)));
}

NamedEffect effect_of(const RefineBench& bench, const RefineState& before, const RefineState& after,
                      const Judgement& judgement) {
  NamedEffect effect;
  effect.evidence = evidence_of(bench, before, after, judgement);
  effect.rivals = judgement.rivals;
  return effect;
}

/// The first of what the trials name that unseen logs do not refuse. `state`: that they began with,
/// and then the one with it.
bool add_one(RefineBench& bench, Trials& trials, std::optional<Trial> trial, RefineState& state,
             RefineResult& result) {
  const bool is_first = result.effects.empty();
  std::string reason;
  for (; trial; trial = trials.next_alike(reason)) {
    const Refinement& row = *trial->winner.variant.refinement;
    reason = why_not(bench, row, state, trial->after, is_first);
    if (!reason.empty() && state.design.whitening.is_needed())
      reason = "from rows freed of what wanders: " + reason;
    result.steps.push_back(step_of(bench, *trial, reason));
    if (reason.empty()) {
      result.effects.push_back(effect_of(bench, state, trial->after, trial->judgement));
      state = std::move(trial->after);
      return true;
    }
    // A crumb has many look-alikes, and one of them passes by chance. A date that is none says
    // nothing of what is always there.
    if (trial->after.rho > kRemainder && !row.is_event) break;
  }
  return false;
}

/// The first effect again, from whitened rows.
bool add_whitened(RefineBench& bench, RefineState& state, RefineResult& result) {
  auto white = whitened(bench, state);
  if (!white) return false;
  Trials trials(bench, *white, true);
  if (!add_one(bench, trials, trials.best(), *white, result)) return false;
  result.league = trials.league();
  bench.first_search = trials.found();
  state = std::move(*white);
  return true;
}

/// What was refused alone may be half of the truth: with the next best beside it, both are judged
/// together. Two names at once need more evidence than one.
bool add_both(RefineBench& bench, RefineState& state, const Trial& one, RefineResult& result) {
  auto two = try_next(bench, one.after);
  if (!two) return false;
  const UnseenChange change = change_of(bench, *two->winner.variant.refinement, state, two->after);
  const std::string reason = why_not_both(change);
  result.steps.push_back(step_of(bench, *two, reason));
  if (!reason.empty()) return false;
  result.steps = {step_of(bench, one, ""), result.steps.back()};
  result.effects.push_back(effect_of(bench, state, one.after, one.judgement));
  result.effects.push_back(effect_of(bench, one.after, two->after, two->judgement));
  state = std::move(two->after);
  return true;
}

}  // namespace

bool add_next_effect(RefineBench& bench, RefineState& state, RefineResult& result) {
  const bool is_first = result.effects.empty();
  Trials trials(bench, state, is_first);
  const auto best = trials.best();
  if (is_first) {
    result.league = trials.league();
    bench.first_search = trials.found();
  }
  if (add_one(bench, trials, best, state, result)) return true;
  if (!is_first) return false;
  if (best && bench.options.most_effects > 1 && add_both(bench, state, *best, result)) return true;
  return state.rho > kRemainder && !bench.elastic_only && add_whitened(bench, state, result);
}

void name_first_again(RefineBench& bench, const RefineState& first, RefineState& state,
                      RefineResult& result) {
  Search found;
  found.levels = state.levels;
  found.fit.x = first.x;
  Candidate second;
  second.variant = state.design.added[bench.n_kept + 1];
  const auto alone = with_candidate(bench, first, found, second);
  if (!alone) return;
  const auto trial = try_next(bench, *alone);
  // A tie goes to what is named beside the other, or alone.
  constexpr double kTie = 1.01;
  const auto is_tie = [&](const RefineState& other) {
    return other.rho <= kTie * state.rho && other.unseen.rho <= kTie * state.unseen.rho;
  };
  Judgement kept;
  kept.chance = {result.effects[1].evidence.p_value, result.effects[1].evidence.is_fitted_tail};
  kept.inclusion = result.effects[1].evidence.inclusion;
  kept.rivals = result.effects[1].rivals;
  if (!trial) {
    if (!is_tie(*alone)) return;
    result.effects = {effect_of(bench, first, *alone, kept)};
    result.steps = {step_of(bench, {kept, second, *alone}, "")};
    state = *alone;
    return;
  }
  const Refinement& row = *trial->winner.variant.refinement;
  NamedEffect& named = result.effects.front();
  if (&row == state.design.added[bench.n_kept].refinement) {
    named.rivals = trial->judgement.rivals;  // fewer: the second no longer blurs it
    return;
  }
  if (!is_tie(trial->after) || !why_not_added(change_of(bench, row, *alone, trial->after)).empty())
    return;
  // In the order of the design: what was second alone, then the new one beside it.
  result.effects = {effect_of(bench, first, *alone, kept),
                    effect_of(bench, *alone, trial->after, trial->judgement)};
  result.steps = {step_of(bench, {kept, second, *alone}, ""), step_of(bench, *trial, "")};
  state = trial->after;
}

void begin_otherwise(RefineBench& bench, const RefineState& first, RefineState& state,
                     RefineResult& result) {
  constexpr std::size_t kBeginnings = 3;
  const Search& found = bench.first_search;
  const Refinement& taken = *state.design.added[bench.n_kept].refinement;
  const bool was_alone = result.effects.size() == 1;
  for (const Candidate* candidate : best_candidates(found.candidates, kBeginnings, taken)) {
    Trial one;
    one.winner =
        refined_shape({first.design, found.grams, found.fit, found.levels}, bench.scan, *candidate);
    auto after = with_candidate(bench, first, found, one.winner);
    if (!after) continue;
    one.after = std::move(*after);
    auto two = try_next(bench, one.after);
    if (!two || two->after.rho >= state.rho) continue;
    const Refinement& row = *two->winner.variant.refinement;
    // Beside what was named alone, the beginning was too little to be named.
    if (was_alone && (&row == &taken || same_class(row, taken))) continue;
    if (!why_not_both(change_of(bench, row, first, two->after)).empty()) continue;
    const SquaredGap gap{found.fit.held_out.sum(),
                         floor_error(found.fit, bench.floor, found.levels)};
    one.judgement = judge_candidate(*candidate, found.candidates, gap, bench.draws, bench.options);
    result.effects = {effect_of(bench, first, one.after, one.judgement),
                      effect_of(bench, one.after, two->after, two->judgement)};
    result.steps = {step_of(bench, one, ""), step_of(bench, *two, "")};
    state = std::move(two->after);
  }
  if (result.effects.size() == 2) name_first_again(bench, first, state, result);
}

}  // namespace cablefit
