#include "cablefit/refine/refine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/base/error.hpp"
#include "cablefit/base/parallel.hpp"
#include "cablefit/estimate/long_run.hpp"
#include "cablefit/refine/final_fit.hpp"
#include "cablefit/refine/null_draws.hpp"
#include "cablefit/refine/regimes.hpp"
#include "cablefit/refine/verdict.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kFloorDraws = 4;  // the floor is then known to about 1 %
constexpr double kNoGap = 1.07;         // squared residual over floor that a base of no fault reaches
constexpr double kClosed = 0.5;         // of the gap: less leaves it unexplained
constexpr double kHeldOutShare = 1.0 / 3;

bool any_part(const PartSurvey&) { return true; }

/// Everything of one run of the workflow.
struct Work {
  const RefineOptions& options;
  ScanSettings scan;
  std::vector<LogSurvey> logs;  ///< blocked, then training
  Smoothing smoothing;
  BaseFit base;                 ///< of the model as it was given, refitted
  Design undone;                ///< the same without anything added, states of the last fit
  KindLevels floor{};
  std::vector<NullDraw> draws;
  Design test;                  ///< the test rows, of the given model
};

void tell(const RefineOptions& options, std::string_view what, double share) {
  if (options.progress) options.progress(what, share);
}

/// The last third of every moving stretch, taken from the others.
std::vector<Stretch> hold_out(std::vector<Stretch>& stretches) {
  std::vector<Stretch> held;
  for (Stretch& stretch : stretches) {
    if (stretch.blocked) continue;
    const Eigen::Index n = stretch.recording.theta.size();
    const auto kept = static_cast<Eigen::Index>((1 - kHeldOutShare) * static_cast<double>(n));
    Stretch last = stretch;
    last.t0 += static_cast<double>(kept) * stretch.recording.period;
    for (Eigen::ArrayXd Recording::*signal :
         {&Recording::q, &Recording::theta, &Recording::tau, &Recording::tau_load}) {
      last.recording.*signal = Eigen::ArrayXd((stretch.recording.*signal).tail(n - kept));
      stretch.recording.*signal = Eigen::ArrayXd((stretch.recording.*signal).head(kept));
    }
    held.push_back(std::move(last));
  }
  return held;
}

KindLevels mean_floor(const std::vector<NullDraw>& draws) {
  KindLevels floor{};
  for (const NullDraw& draw : draws)
    for (std::size_t k = 0; k < kRowKinds; ++k)
      floor[k] += draw.floor[k] * draw.floor[k] / static_cast<double>(draws.size());
  for (double& level : floor) level = level > 0 ? std::sqrt(level) : 1.0;
  return floor;
}

std::vector<NullDraw> run_draws(const Work& work, std::size_t n, std::string_view what,
                                const std::function<NullDraw(std::uint64_t)>& draw) {
  std::vector<NullDraw> draws;
  ordered_pipeline<std::uint64_t>(
      work.options.threads,
      [&](auto emit) {
        for (std::size_t k = 0; k < n; ++k) emit(std::uint64_t{work.options.seed + k});
      },
      draw,
      [&](NullDraw one) {
        draws.push_back(std::move(one));
        tell(work.options, what, static_cast<double>(draws.size()) / static_cast<double>(n));
      });
  return draws;
}

/// Squared residual over what the floor leaves, all kinds together.
double rho_of(const BlockFit& fit, const KindLevels& floor) {
  double sum = 0, n = 0;
  for (std::size_t k = 0; k < kRowKinds; ++k) {
    sum += fit.squares[k] / (floor[k] * floor[k]);
    n += fit.n_rows[k];
  }
  return n > 0 ? sum / n : 0;
}

/// What noise alone would leave of the weighted squared error.
double floor_error(const BlockFit& fit, const KindLevels& floor, const KindLevels& levels) {
  double sum = 0;
  for (std::size_t k = 0; k < kRowKinds; ++k)
    sum += fit.n_rows[k] * floor[k] * floor[k] / (levels[k] * levels[k]);
  return sum;
}

/// The weighted rms of the test rows under training values, as one torque.
double test_gap(const Design& test, const Eigen::VectorXd& x, const KindLevels& levels) {
  const BlockGrams grams = block_grams(test.rows, test.stretches, 2);
  const KindLevels rms = rms_of(grams, x);
  double sum = 0, n = 0;
  for (std::size_t k = 0; k < kRowKinds; ++k) {
    double rows = 0;
    for (const auto& block : grams.blocks) rows += static_cast<double>(block.n_rows[k]);
    sum += rows * rms[k] * rms[k] / (levels[k] * levels[k]);
    n += rows;
  }
  return n > 0 ? std::sqrt(sum / n) : 0;
}

KindLevels at_least(KindLevels levels, const KindLevels& floor) {
  for (std::size_t k = 0; k < kRowKinds; ++k) levels[k] = std::max(levels[k], floor[k]);
  return levels;
}

/// Rows already named, and their aliases, are no candidates again.
std::vector<const Refinement*> without_named(const Design& design) {
  std::vector<const Refinement*> out;
  for (const Variant& variant : design.added)
    for (const Refinement& row : refinements()) {
      const Refinement& named = *variant.refinement;
      const bool alias = !row.alias_class.empty() && row.alias_class == named.alias_class;
      if (&row == &named || alias) out.push_back(&row);
    }
  return out;
}

/// The search at one step: floor weights first, then those of what its best leaves, since a large
/// unexplained part of one equation would drown the other (row weights after clutter).
struct Search {
  KindLevels levels{};
  BlockFit fit;
  std::vector<Candidate> candidates;
};
Search search(const Work& work, const Design& design) {
  constexpr int kPasses = 2;
  Search s;
  s.levels = work.floor;
  const BlockGrams grams = block_grams(design.rows, design.stretches, work.scan.block_seconds);
  const auto without = without_named(design);
  for (int pass = 0; pass < kPasses; ++pass) {
    auto fit = fit_blocks(grams, s.levels, true, 1e-12);
    if (!fit) throw Error(ErrorKind::not_identifiable, "the refined model is not identifiable");
    s.fit = std::move(*fit);
    s.candidates = scan({design, grams, s.fit, s.levels}, work.scan, without);
    const auto best = std::max_element(
        s.candidates.begin(), s.candidates.end(), [](const Candidate& a, const Candidate& b) {
          const auto score = [](const Candidate& c) {
            return c.refused.empty() && !c.variant.refinement->is_event ? c.gain : -1;
          };
          return score(a) < score(b);
        });
    const KindLevels left = at_least(
        best != s.candidates.end() && best->gain > 0 ? best->rms : s.fit.rms(), work.floor);
    const bool same = std::equal(left.begin(), left.end(), s.levels.begin(),
                                 [](double a, double b) { return a < 1.1 * b; });
    if (same || pass + 1 == kPasses) break;
    s.levels = left;
  }
  return s;
}

Estimate estimate_of(const ParameterInfo& info, double value, double sd, double dof) {
  Estimate e;
  e.name = info.name;
  e.symbol = info.symbol;
  e.unit = info.unit;
  e.value = value;
  if (!(sd > 0) || !std::isfinite(sd)) return e;
  e.sd = e.sd_white = sd;
  const double reach = t_quantile_975(dof) * sd;
  e.ci_low = value - reach;
  e.ci_high = value + reach;
  return e;
}

/// Amplitude of each harmonic from its sine and cosine, by the delta method.
std::vector<Estimate> amplitudes(const Refinement& row, const FinalFit& fit, Eigen::Index first) {
  static constexpr ParameterInfo kNames[] = {
      {"amplitude", "A", "", "of the first harmonic", 0},
      {"amplitude_2", "A_2", "", "of the second harmonic", 0},
      {"amplitude_3", "A_3", "", "of the third harmonic", 0}};
  std::vector<Estimate> out;
  for (int h = 0; h < std::min(row.n_harmonics, 3); ++h) {
    const Eigen::Index at = first + 2 * h;
    const double a = std::hypot(fit.x(at), fit.x(at + 1));
    if (!(a > 0)) continue;
    const Eigen::Vector2d slope(fit.x(at) / a, fit.x(at + 1) / a);
    const double sd = std::sqrt(slope.dot(fit.covariance.block<2, 2>(at, at) * slope));
    out.push_back(estimate_of(kNames[h], a, sd, fit.degrees_of_freedom));
    out.back().unit = row.parameters[static_cast<std::size_t>(2 * h)].unit;
  }
  return out;
}

/// Parameters of what was added, in the order of their rows.
void fill_parameters(const Design& design, const FinalFit& fit, std::vector<NamedEffect>& effects) {
  const auto first = first_columns(design);
  Eigen::Index shape_at = design.n_columns();
  for (std::size_t k = 0; k < design.added.size(); ++k) {
    const Variant& variant = design.added[k];
    const Refinement& row = *variant.refinement;
    NamedEffect& effect = effects[k];
    effect.instance.refinement = &row;
    effect.instance.event_log = variant.event_log;
    effect.instance.event_time = variant.event_time;
    effect.instance.parameters.clear();
    const auto sd = [&](Eigen::Index i) { return std::sqrt(fit.covariance(i, i)); };
    for (std::size_t p = 0; p < row.n_linear(); ++p) {
      const Eigen::Index at = first[k] + static_cast<Eigen::Index>(p);
      effect.instance.parameters.push_back(
          estimate_of(row.parameters[p], fit.x(at), sd(at), fit.degrees_of_freedom));
    }
    for (std::size_t p = 0; p < variant.shape.size(); ++p, ++shape_at)
      effect.instance.parameters.push_back(
          estimate_of(row.parameters[row.n_linear() + p], variant.shape[p], sd(shape_at),
                      fit.degrees_of_freedom));
    effect.derived = amplitudes(row, fit, first[k]);
    if (row.n_linear() > 0)
      effect.torque_rms = carried_torque(design, fit.x, first[k],
                                         static_cast<Eigen::Index>(row.n_linear()));
  }
}

void fill_shifts(const Work& work, const Design& design, const FinalFit& fit,
                 RefineResult& result) {
  for (std::size_t i = 0; i < design.layout.effects.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const ParameterInfo& info = design.layout.effects[i];
    result.shifts.push_back({std::string(info.name), std::string(info.unit), work.base.fit.x(at),
                             fit.x(at), std::sqrt(fit.covariance(at, at))});
  }
}

/// sd of the model's own parameters, for the file.
void set_sds(const FinalFit& fit, const BaseLayout& layout, Model& model) {
  Eigen::Index next = 0;
  const auto set = [&](Estimate& e) {
    const std::string name = e.name, symbol = e.symbol, unit = e.unit;
    e = estimate_of({name, symbol, unit, ""}, e.value, std::sqrt(fit.covariance(next, next)),
                    fit.degrees_of_freedom);
    ++next;
  };
  for (auto* effects : {&model.joints.front().link, &model.joints.front().motor})
    for (EffectInstance& instance : *effects)
      for (std::size_t i = 0; i < instance.effect->n_linear(); ++i) set(instance.parameters[i]);
  if (model.rigid) return;
  const Eigen::Index elastic = layout.n_link + layout.n_motor;
  for (Eigen::Index i = 0; i < layout.n_elastic; ++i) {
    if (static_cast<std::size_t>(i) >= model.elastic.size()) break;
    model.elastic[static_cast<std::size_t>(i)].value = fit.x(elastic + i);
    next = elastic + i;
    set(model.elastic[static_cast<std::size_t>(i)]);
  }
}

/// What may be told apart at all, from the columns alone.
std::vector<std::string> not_separable(const std::vector<Candidate>& candidates) {
  std::vector<std::string> out;
  for (const Refinement& row : refinements()) {
    const bool found = std::any_of(candidates.begin(), candidates.end(), [&](const Candidate& c) {
      return c.variant.refinement == &row;
    });
    if (!found) out.push_back(fmt::format("{} ({})", row.name, to_string(row.site)));
  }
  return out;
}

std::string quantity(double value) { return fmt::format("{:.3g}", value); }

void conclude(const Work& work, RefineResult& result, double p_value_seen) {
  const double rho = result.rho_before;
  if (!result.effects.empty()) {
    const bool alone = result.effects.front().rivals.empty();
    result.verdict = alone ? Verdict::named : Verdict::ambiguous;
    const double closed = (rho - result.rho_after) / std::max(1e-9, rho - 1);
    result.reason = fmt::format("{:.0f} % of the squared gap above the noise floor closed",
                                100 * std::clamp(closed, 0.0, 1.0));
    if (closed < kClosed && result.rho_after > 1.2)
      result.reason += "; the remainder is unexplained";
    return;
  }
  if (rho < kNoGap || (rho < 1.2 && p_value_seen > work.options.significance)) {
    result.verdict = Verdict::none;
    result.reason = fmt::format("the residual is {} times its noise floor (squared), and nothing "
                                "in the catalogue improves on that beyond chance",
                                quantity(rho));
    return;
  }
  result.verdict = Verdict::unexplained;
  result.reason = fmt::format("the squared residual is {} times its noise floor, and no effect of "
                              "the catalogue explains it",
                              quantity(rho));
}

}  // namespace

std::string_view to_string(Verdict verdict) {
  constexpr std::array<std::string_view, 4> kNames{"named", "none", "ambiguous", "unexplained"};
  return kNames[static_cast<std::size_t>(verdict)];
}

RefineResult refine(std::span<const Model> models, const RefineLogs& logs,
                    const RefineOptions& options) {
  RefineResult result;
  Work work{options, {}, {}, {}, {}, {}, {}, {}, {}};
  work.scan.threads = options.threads;
  work.logs = logs.blocked;
  work.logs.insert(work.logs.end(), logs.train.begin(), logs.train.end());
  for (const auto* some : {&logs.blocked, &logs.train, &logs.test})
    for (const LogSurvey& log : *some)
      result.inputs.push_back({log.plan.path, log.sha256, log.n_rows});
  for (const Model& model : models) result.preloads.push_back(model.preload);
  result.rigid = models.front().rigid;
  result.linear_motion = models.front().rig.linear_motion;

  std::vector<Stretch> train = read_stretches(work.logs, models, any_part);
  if (train.empty()) throw input_error({}, "no log to refine with", "give moving logs with --train");
  std::vector<Stretch> test = read_stretches(logs.test, models, any_part);
  if (test.empty()) {
    test = hold_out(train);
    result.held_out_blocks = true;
  }
  work.smoothing = smoothing_for(train.front().recording.period);
  work.base = fit_base(make_design(models, std::move(train), work.smoothing),
                       work.scan.block_seconds, nullptr);
  work.smoothing = work.base.design.smoothing;

  const NullBench bench(work.base.design.models, work.logs, any_part, work.smoothing);
  work.floor = mean_floor(run_draws(work, kFloorDraws, "noise floor", [&](std::uint64_t seed) {
    return bench.base_only(seed, nullptr);
  }));
  work.base = fit_base(std::move(work.base.design), work.scan.block_seconds, &work.floor);
  result.rho_before = rho_of(work.base.fit, work.floor);
  result.where = find_regimes(work.base.design, work.base.fit.x, work.floor);
  work.test = make_design(work.base.design.models, std::move(test), work.smoothing);

  Design design = work.base.design;
  Design test_design = work.test;
  work.undone = design;
  BlockFit current = work.base.fit;
  KindLevels levels = work.floor;
  result.torque.train_before = result.torque.train_after = std::sqrt(result.rho_before);
  result.torque.test_before = result.torque.test_after =
      test_gap(test_design, work.base.fit.x, work.floor);
  result.rho_after = result.rho_before;
  double p_seen = 1;

  for (std::size_t step = 0; step < options.most_effects; ++step) {
    tell(options, "search", static_cast<double>(step));
    const Search found = search(work, design);
    if (step == 0) result.not_separable = not_separable(found.candidates);
    if (work.draws.empty() && anything_material(found.candidates, options)) {
      ScanSettings settings = work.scan;
      settings.threads = 1;
      work.draws = run_draws(work, options.n_draws, "chance", [&](std::uint64_t seed) {
        return bench.searched(seed + kFloorDraws, work.floor, settings);
      });
    }
    const SquaredGap gap{found.fit.held_out.sum(),
                         floor_error(found.fit, work.floor, found.levels)};
    const Judgement judgement =
        judge_search(found.candidates, gap, work.draws, options, step == 0);
    if (step == 0) result.league = judgement.league;
    if (!judgement.is_named) break;
    if (step == 0) p_seen = judgement.p_value;
    const BlockGrams grams = block_grams(design.rows, design.stretches, work.scan.block_seconds);
    const Candidate winner =
        refined_shape({design, grams, found.fit, found.levels}, work.scan, *judgement.best);

    Design next = with_variant(design, winner.variant, found.fit.x);
    Design next_test = with_variant(test_design, winner.variant, found.fit.x);
    auto fit = fit_blocks(block_grams(next.rows, next.stretches, work.scan.block_seconds),
                          found.levels, true, 1e-12);
    if (!fit) break;
    const double test_after = test_gap(next_test, fit->x, work.floor);
    RefineStep told;
    told.added = winner.variant.refinement->name;
    told.side = to_string(winner.variant.refinement->site);
    told.gap_train = std::sqrt(rho_of(*fit, work.floor));
    told.gap_test = test_after;
    told.accepted = winner.variant.refinement->is_event || test_after < result.torque.test_after;
    if (!told.accepted) {
      told.reason = "it does not improve the test logs";
      result.steps.push_back(told);
      break;
    }
    NamedEffect effect;
    const double before = rho_of(current, work.floor), after = rho_of(*fit, work.floor);
    effect.evidence = {before > 1 ? std::min(1.0, (before - after) / (before - 1)) : 0,
                       before,
                       after,
                       judgement.p_value,
                       judgement.inclusion,
                       work.draws.size()};
    const double unseen_before = result.torque.test_after, unseen_after = test_after;
    if (unseen_before > 1.05)
      effect.evidence.gain = (unseen_before * unseen_before - unseen_after * unseen_after) /
                             (unseen_before * unseen_before - 1);
    effect.rivals = judgement.rivals;
    result.effects.push_back(effect);
    result.steps.push_back(told);
    result.torque.test_after = test_after;
    result.torque.train_after = told.gap_train;
    result.rho_after = after;
    design = std::move(next);
    test_design = std::move(next_test);
    current = std::move(*fit);
    levels = found.levels;
    if (result.rho_after < kNoGap) break;
  }

  const FinalFit final = final_fit(work.undone, design, levels, work.scan.block_seconds);
  fill_parameters(design, final, result.effects);
  fill_shifts(work, design, final, result);
  result.floor_link = result.rigid ? 0 : work.floor[0];
  result.floor_motor = work.floor[1];
  const auto above = [](double rms, double floor) {
    return std::sqrt(std::max(0.0, rms * rms - floor * floor));
  };
  result.remainder_link = result.rigid ? 0 : above(final.rms[0], work.floor[0]);
  result.remainder_motor = above(final.rms[1], work.floor[1]);
  result.torque.noise_floor = 1;
  // As torques: of the motor equation, in which every log has rows.
  for (double* gap : {&result.torque.train_before, &result.torque.train_after,
                      &result.torque.test_before, &result.torque.test_after,
                      &result.torque.noise_floor})
    *gap *= work.floor[1];
  result.torque.known = true;
  result.models = design.models;
  for (Model& model : result.models) {
    set_base_values(final.x.head(design.layout.n()), model);
    set_sds(final, design.layout, model);
  }
  conclude(work, result, p_seen);
  if (!result.effects.empty() && !result.effects.front().rivals.empty())
    result.next_experiment = result.effects.front().rivals.front().experiment;
  return result;
}

}  // namespace cablefit
