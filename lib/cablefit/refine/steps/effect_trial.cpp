#include "cablefit/refine/steps/effect_trial.hpp"

#include <algorithm>

#include "cablefit/refine/gap_levels.hpp"
#include "cablefit/refine/rows/physical_values.hpp"
#include "cablefit/refine/search/golden.hpp"
#include "cablefit/refine/verdict/conclusion.hpp"

namespace cablefit {
namespace {

// Tensions and stiffness that columns are made of were those of a model without the effect.
constexpr int kRelinearisations = 3;

/// Fitted again and again, each time with what follows from the values before.
std::optional<BlockFit> settled_fit(const RefineBench& bench, const KindLevels& levels, int rounds,
                                    Design& design) {
  std::optional<BlockFit> fit;
  for (int round = 0; round < rounds; ++round) {
    if (round > 0) design = relinearised(design, fit->x);
    fit = fit_blocks(block_grams(design, bench.scan.block_seconds), levels, false);
    if (!fit) return {};
  }
  return fit;
}

/// with_candidate where the effect's cables follow from coefficients that are fitted with it: those
/// that the search had are of a model without it, and its shape is then off by some per cent.
std::optional<RefineState> with_own_coefficients(const RefineBench& bench, const RefineState& state,
                                                 const Search& found, Candidate& winner) {
  constexpr double kAround = 0.1;
  constexpr int kSettling = 8;
  if (!applies(state.design, winner.variant)) return {};
  Design design = with_variant(state.design, winner.variant, found.fit.x);
  auto fit = settled_fit(bench, found.levels, kSettling, design);
  for (std::size_t i = 0; fit && i < winner.variant.shape.size(); ++i) {
    if (!is_free(winner.variant, i)) continue;
    double& value = winner.variant.shape[i];
    const auto rho_with = [&](double other) {
      design.added.back().shape[i] = other;
      if (fit) design = relinearised(design, fit->x);
      if (fit) fit = settled_fit(bench, found.levels, kRelinearisations, design);
      return fit ? rho_of(*fit, bench.floor) : kUnbounded;
    };
    value = golden((1 - kAround) * value, (1 + kAround) * value, rho_with);
    rho_with(value);
  }
  if (!fit) return {};
  const Eigen::VectorXd own = fit->x.head(state.design.n_columns());
  RefineState there = state;
  there.design = relinearised(state.design, own);
  return with_candidate(bench, there, found, winner);
}

/// Whether there is nothing to explain, even if some effect fits better under the null. Blocked
/// rows alone are few, and their floor is known less well. A kept effect of the model leaves a
/// small residual, like an added one.
bool is_at_floor(const RefineBench& bench, const RefineState& state) {
  if (bench.elastic_only) return state.rho < kNoGap && state.held_out.rho < kVisibleGap;
  const bool is_kept_base = bench.n_kept > 0 && state.design.added.size() == bench.n_kept;
  return is_kept_base ? state.rho < kNoGap : state.rho <= 1;
}

}  // namespace

std::optional<RefineState> with_candidate(const RefineBench& bench, const RefineState& state,
                                          const Search& found, const Candidate& winner) {
  if (!applies(state.design, winner.variant)) return {};
  RefineState next;
  next.design = with_variant(state.design, winner.variant, found.fit.x);
  next.levels = found.levels;
  const auto fit = settled_fit(bench, next.levels, kRelinearisations, next.design);
  if (!fit) return {};
  next.x = physical_values(next.design, bench.scan.block_seconds, next.levels, fit->x);
  judge(bench, *fit, next);
  return next;
}

Trials::Trials(RefineBench& bench, const RefineState& state, bool is_first)
    : bench_(bench), state_(state), is_first_(is_first) {
  report_progress(bench.options, "search", 0);
  found_ = search(state.design, bench.floor, bench.scan);
  // Draws end where more would hardly change the answer (Besag & Clifford 1991).
  if (bench.draws.empty()) draw_more(bench, state, found_);
  while (!judged().is_settled && draw_more(bench, state, found_)) {
  }
}

Judgement Trials::judged() const {
  const SquaredGap gap{found_.fit.held_out.sum(),
                       floor_error(found_.fit, bench_.floor, found_.levels)};
  return judge_search(found_.candidates, gap, bench_.draws, bench_.options,
                      is_first_ && bench_.n_kept == 0);
}

std::optional<Trial> Trials::best() {
  Judgement judgement = judged();
  ranking_ = judgement.ranking;
  chance_ = judgement.search;
  if (!judgement.is_named || is_at_floor(bench_, state_)) return {};
  last_ = judgement.best->variant.effect;
  alike_ = judgement.rivals;
  return tried(std::move(judgement));
}

std::optional<Trial> Trials::next_alike(const std::string& refusal) {
  if (last_ == nullptr) return {};
  for (Candidate& candidate : found_.candidates) {
    const Effect& row = *candidate.variant.effect;
    const bool both_dates = row.is_event && last_->is_event;
    if (&row == last_ || same_class(row, *last_) || both_dates) candidate.refused = refusal;
  }
  Judgement judgement = judged();
  if (!judgement.is_named) return {};
  last_ = judgement.best->variant.effect;
  const bool is_alike = std::any_of(alike_.begin(), alike_.end(), [&](const Rival& rival) {
    return rival.name == last_->name && rival.side == to_string(last_->site);
  });
  return is_alike ? tried(std::move(judgement)) : std::nullopt;
}

std::optional<Trial> Trials::tried(Judgement judgement) const {
  Trial trial;
  trial.judgement = std::move(judgement);
  trial.winner = refined_shape({state_.design, found_.grams, found_.fit, found_.levels},
                               bench_.scan, *trial.judgement.best);
  trial.judgement.best = nullptr;  // of the search, which ends before the trial
  auto next = trial.winner.variant.effect->change_again != nullptr
                  ? with_own_coefficients(bench_, state_, found_, trial.winner)
                  : with_candidate(bench_, state_, found_, trial.winner);
  if (!next) return {};
  trial.after = std::move(*next);
  return trial;
}

std::optional<Trial> try_next(RefineBench& bench, const RefineState& state) {
  return Trials(bench, state, false).best();
}

}  // namespace cablefit
