#include "cablefit/refine/steps/effect_steps.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "cablefit/estimate/spread/tail_probability.hpp"
#include "cablefit/refine/gap_levels.hpp"
#include "cablefit/refine/steps/effect_trial.hpp"
#include "cablefit/refine/verdict/conclusion.hpp"
#include "cablefit/refine/verdict/plausible.hpp"
#include "cablefit/refine/verdict/verdict.hpp"

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
  e.n_draws = bench.draws.size();
  return e;
}

/// `reason`: of a refusal.
RefineStep step_of(const RefineBench& bench, const Trial& trial, const std::string& reason) {
  const Effect& row = *trial.winner.variant.effect;
  RefineStep step;
  step.added = row.name;
  step.side = to_string(row.site);
  step.gap_train = bench.unit() * std::sqrt(trial.after.rho);
  step.gap_held_out = bench.unit() * std::sqrt(trial.after.held_out.rho);
  step.reason = reason;
  step.accepted = reason.empty();
  return step;
}

/// How much better held-out blocks fit, in sd over the blocks, weighted as the search was.
double sd_better(const RefineBench& bench, const RefineState& before, const RefineState& after) {
  const auto gap = [&](const RefineState& state) {
    const BlockGrams grams = block_grams(state.design, bench.scan.block_seconds);
    return held_out_gap(grams, after.levels, after.levels);
  };
  const RowGap a = gap(before), b = gap(after);
  const auto both = a.n_rows > 0 && b.n_rows > 0;
  return paired(both.select(a.squares, 0), both.select(b.squares, 0)).in_sd();
}

/// p-value of the last effect's coefficients, from the sandwich over the blocks, which allows
/// low-frequency disturbances (White 1980), and with few blocks (Hotelling 1931). 0 for an effect
/// without coefficients.
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

/// Mean over the blocks that both states predict.
double shared_rho(const RowGap& gap, const RowGap& other) {
  const auto both = gap.n_rows > 0 && other.n_rows > 0;
  const double rows = both.select(gap.n_rows, 0).sum();
  return rows > 0 ? both.select(gap.squares, 0).sum() / rows : gap.rho;
}

/// On the training logs alone: by held-out blocks.
HeldOutChange change_of(const RefineBench& bench, const Effect& row, const RefineState& before,
                        const RefineState& after) {
  return {row,
          shared_rho(before.held_out, after.held_out),
          shared_rho(after.held_out, before.held_out),
          after.rho > kRemainder,
          sd_better(bench, before, after),
          row.lasts(),
          (before.rho - after.rho) / std::max(1e-9, before.rho - 1),
          chance_of_size(bench, after),
          before.rho - after.rho};
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

/// Reason against a step; empty: none.
std::string why_not(const RefineBench& bench, const Effect& row, const RefineState& before,
                    const RefineState& after) {
  // Dates are many, and most logs without a visible gap have no event.
  if (row.is_event && before.rho < kVisibleGap)
    return fmt::format(
        "the squared residual without it is {:.3g} times the noise floor; an event "
        "needs {:g}",
        before.rho, kVisibleGap);
  if (carries_nothing(bench, after)) return "it has no torque when everything is fitted with it";
  if (std::string reason = why_not_plausible(after.design, after.x); !reason.empty()) return reason;
  return why_not_added(change_of(bench, row, before, after));
}

NamedEffect effect_of(const RefineBench& bench, const RefineState& before, const RefineState& after,
                      const Judgement& judgement) {
  NamedEffect effect;
  effect.evidence = evidence_of(bench, before, after, judgement);
  effect.rivals = judgement.rivals;
  return effect;
}

/// The first of what the trials name that is not refused.
bool add_one(RefineBench& bench, Trials& trials, std::optional<Trial> trial, Chain& chain,
             RefineResult& result) {
  for (; trial; trial = trials.next_alike(result.steps.back().reason)) {
    const Effect& row = *trial->winner.variant.effect;
    const std::string reason = why_not(bench, row, chain.back(), trial->after);
    result.steps.push_back(step_of(bench, *trial, reason));
    if (reason.empty()) {
      result.effects.push_back(effect_of(bench, chain.back(), trial->after, trial->judgement));
      chain.push_back(std::move(trial->after));
      return true;
    }
    // Many effects are similar to a small one, and one of them passes under the null. A date that
    // is none says nothing of what is always there.
    if (trial->after.rho > kRemainder && !row.is_event) break;
  }
  return false;
}

/// Two effects, the second found beside the first, as the whole result.
void take_both(RefineBench& bench, Trial one, Trial two, Chain& chain, RefineResult& result) {
  result.effects = {effect_of(bench, chain.front(), one.after, one.judgement),
                    effect_of(bench, one.after, two.after, two.judgement)};
  result.steps = {step_of(bench, one, ""), step_of(bench, two, "")};
  chain.resize(1);
  chain.push_back(std::move(one.after));
  chain.push_back(std::move(two.after));
  chain.back().is_joint = true;
}

/// What was refused alone may be half of the truth: with the next best beside it, both are judged
/// together. Two names at once need more evidence than one.
bool add_both(RefineBench& bench, Trial one, Chain& chain, RefineResult& result) {
  if (one.winner.variant.effect->is_event) return false;
  auto two = try_next(bench, one.after);
  if (!two) return false;
  const std::string reason =
      why_not_both(change_of(bench, *two->winner.variant.effect, chain.front(), two->after));
  if (reason.empty())
    take_both(bench, std::move(one), std::move(*two), chain, result);
  else
    result.steps.push_back(step_of(bench, *two, reason));
  return reason.empty();
}

}  // namespace

bool add_next_effect(RefineBench& bench, Chain& chain, RefineResult& result) {
  const bool is_first = result.effects.empty();
  const RefineState state = chain.back();
  Trials trials(bench, state, is_first);
  auto best = trials.best();
  if (is_first) {
    result.ranking = trials.ranking();
    result.search_p = trials.chance().p;
    result.search_p_is_fitted = trials.chance().is_fitted;
    result.n_draws = bench.draws.size();
    bench.first_search = trials.found();
  }
  if (add_one(bench, trials, best, chain, result)) return true;
  return is_first && best && bench.options.most_effects > 1 &&
         add_both(bench, std::move(*best), chain, result);
}

void name_first_again(RefineBench& bench, Chain& chain, RefineResult& result) {
  const RefineState &first = chain.front(), &state = chain.back();
  Search found;
  found.levels = state.levels;
  found.fit.x = first.x;
  Trial alone;
  alone.winner.variant = state.design.added[bench.n_kept + 1];
  auto with_second = with_candidate(bench, first, found, alone.winner);
  if (!with_second) return;
  alone.after = std::move(*with_second);
  auto trial = try_next(bench, alone.after);
  // A tie goes to what is named beside the other, or alone.
  constexpr double kTie = 1.01;
  const auto is_tie = [&](const RefineState& other) {
    return other.rho <= kTie * state.rho && other.held_out.rho <= kTie * state.held_out.rho;
  };
  const RefineEvidence& evidence = result.effects[1].evidence;
  alone.judgement.chance = {evidence.p_value, evidence.is_fitted_tail};
  alone.judgement.inclusion = evidence.inclusion;
  alone.judgement.rivals = result.effects[1].rivals;
  if (!trial) {
    if (!is_tie(alone.after)) return;
    result.effects = {effect_of(bench, first, alone.after, alone.judgement)};
    result.steps = {step_of(bench, alone, "")};
    chain.resize(1);
    chain.push_back(std::move(alone.after));
    return;
  }
  const Effect& row = *trial->winner.variant.effect;
  if (&row == state.design.added[bench.n_kept].effect) {
    // Fewer: the second no longer blurs it.
    result.effects.front().rivals = trial->judgement.rivals;
    return;
  }
  if (is_tie(trial->after) &&
      why_not_added(change_of(bench, row, alone.after, trial->after)).empty())
    take_both(bench, std::move(alone), std::move(*trial), chain, result);
}

void begin_otherwise(RefineBench& bench, Chain& chain, RefineResult& result) {
  constexpr std::size_t kBeginnings = 3;
  const RefineState first = chain.front();
  const Search& found = bench.first_search;
  const Effect& taken = *chain.back().design.added[bench.n_kept].effect;
  const bool was_alone = result.effects.size() == 1;
  for (const Candidate* candidate : best_candidates(found.candidates, kBeginnings, taken)) {
    Trial one;
    one.winner =
        refined_shape({first.design, found.grams, found.fit, found.levels}, bench.scan, *candidate);
    auto after = with_candidate(bench, first, found, one.winner);
    if (!after) continue;
    one.after = std::move(*after);
    auto two = try_next(bench, one.after);
    if (!two || two->after.rho >= chain.back().rho) continue;
    const Effect& row = *two->winner.variant.effect;
    // Beside what was named alone, the beginning was too little to be named.
    if (was_alone && (&row == &taken || same_class(row, taken))) continue;
    if (!why_not_both(change_of(bench, row, first, two->after)).empty()) continue;
    const SquaredGap gap{found.fit.held_out.sum(),
                         floor_error(found.fit, bench.floor, found.levels)};
    one.judgement = judge_candidate(*candidate, found.candidates, gap, bench.draws, bench.options);
    take_both(bench, std::move(one), std::move(*two), chain, result);
  }
  if (result.effects.size() == 2) name_first_again(bench, chain, result);
}

}  // namespace cablefit
