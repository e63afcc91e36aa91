#include "cablefit/refine/refine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "cablefit/refine/bases/own_base.hpp"
#include "cablefit/refine/bounded_work.hpp"
#include "cablefit/refine/figures/refine_figures.hpp"
#include "cablefit/refine/gap_levels.hpp"
#include "cablefit/refine/joints.hpp"
#include "cablefit/refine/null/kept_effects.hpp"
#include "cablefit/refine/rows/physical_values.hpp"
#include "cablefit/refine/rows/refined_model.hpp"
#include "cablefit/refine/steps/best_shapes.hpp"
#include "cablefit/refine/steps/effect_steps.hpp"
#include "cablefit/refine/steps/elastic_stage.hpp"
#include "cablefit/refine/steps/elongation_error.hpp"
#include "cablefit/refine/steps/materiality.hpp"
#include "cablefit/refine/steps/next_run.hpp"
#include "cablefit/refine/steps/refine_bench.hpp"
#include "cablefit/refine/steps/sure_sizes.hpp"
#include "cablefit/refine/steps/test_reading.hpp"
#include "cablefit/refine/verdict/conclusion.hpp"
#include "cablefit/refine/verdict/inseparable_rivals.hpp"
#include "cablefit/refine/verdict/regimes.hpp"
#include "cablefit/refine/verdict/separability.hpp"
#include "cablefit/refine/verdict/unexplained.hpp"
#include "cablefit/samples/rows/agreement.hpp"

namespace cablefit {
namespace {

/// The model does not contain the time of an event, so it simulates the log as if there were none.
bool simulates_an_event(const RefineResult& result) {
  return result.held_out_blocks &&
         std::any_of(result.effects.begin(), result.effects.end(),
                     [](const NamedEffect& effect) { return effect.instance.effect->is_event; });
}

void set_gaps(const RefineBench& bench, const Chain& chain,
              const std::vector<TestReading>& readings, RefineResult& result) {
  const TestReading &first = readings.front(), &last = readings.back();
  const double unit = bench.test_unit();
  GapStory& torque = result.torque;
  torque.known = true;
  torque.noise_floor = unit;
  torque.train_before = bench.unit() * std::sqrt(chain.front().rho);
  torque.train_after = bench.unit() * std::sqrt(chain.back().rho);
  torque.test_before = unit * std::sqrt(first.gap.rho);
  torque.test_after = unit * std::sqrt(last.gap.rho);
  for (std::size_t i = 0; i < 2; ++i) {
    const double level = i == 0 ? 0.025 : 0.975;
    torque.test_before_ci[i] = unit * std::sqrt(first.gap.quantile(level));
    torque.test_after_ci[i] = unit * std::sqrt(last.gap.quantile(level));
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
  if (simulation.known && simulates_an_event(result)) {
    simulation.known = false;
    result.warnings.emplace_back(
        "not simulated: the last third is of logs in which the event happened, and the model does "
        "not have its time; give logs from after it with --test");
  }
}

void set_remainder(const KindLevels& rms, const KindLevels& floor, RefineResult& result) {
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

/// The values of what stands in the design, kept effects first.
void set_effects(std::span<const Model> models, const std::vector<NamedEffect>& named,
                 RefineResult& result) {
  const std::size_t n_kept = named.size() - result.effects.size();
  for (std::size_t k = 0; k < n_kept; ++k) {
    KeptEffect& kept = result.kept.emplace_back();
    kept.now = named[k];
    for (const EffectInstance& given : models.front().joints.front().added)
      if (given.effect == named[k].instance.effect) kept.given = given.parameters;
  }
  for (std::size_t k = 0; k < result.effects.size(); ++k) {
    const NamedEffect& fitted = named[n_kept + k];
    result.effects[k].instance = fitted.instance;
    result.effects[k].derived = fitted.derived;
    result.effects[k].torque_rms = fitted.torque_rms;
  }
}

void set_inputs(std::span<const Model> models, const RefineLogs& logs, RefineResult& result) {
  for (const auto* some : {&logs.blocked, &logs.train, &logs.test})
    for (const LogSurvey& log : *some)
      result.inputs.push_back({log.plan.path, log.sha256, log.n_rows});
  for (const Model& model : models) result.preloads.push_back(model.preload);
  result.rigid = models.front().rigid;
  result.axes = models.front().rig.axes.all();
  result.rig_path = models.front().rig.path;
}

}  // namespace

std::vector<LogSurvey> RefineLogs::fitted() const {
  std::vector<LogSurvey> all = blocked;
  all.insert(all.end(), train.begin(), train.end());
  return all;
}

RefineResult::RefineResult() = default;
RefineResult::RefineResult(const RefineResult&) = default;
RefineResult::RefineResult(RefineResult&&) noexcept = default;
RefineResult& RefineResult::operator=(const RefineResult&) = default;
RefineResult& RefineResult::operator=(RefineResult&&) noexcept = default;
RefineResult::~RefineResult() = default;

std::string_view to_string(Verdict verdict) {
  constexpr std::array<std::string_view, 4> kNames{"named", "none", "ambiguous", "unexplained"};
  return kNames[static_cast<std::size_t>(verdict)];
}

namespace {

/// Effects that the training logs confirm, one after the other.
void find_effects(RefineBench& bench, Chain& chain, RefineResult& result) {
  const std::size_t most = bench.options.most_effects;
  while (result.effects.size() < most && add_next_effect(bench, chain, result)) {
    if (result.effects.size() == 2) {
      name_first_again(bench, chain, result);
      if (chain.back().rho >= kNoGap && result.effects.size() == 2)
        begin_otherwise(bench, chain, result);
    }
    if (chain.back().rho < kNoGap) break;
  }
  if (result.effects.size() == 1 && most > 1 && chain.back().rho > kRemainder)
    begin_otherwise(bench, chain, result);
  if (!result.effects.empty()) chain.back() = with_best_shapes(bench, std::move(chain.back()));
}

/// By the size that the user gave: no residual of the base is worth a search for its cause.
bool is_immaterial(const RefineBench& bench, const RefineState& first) {
  if (!bench.options.material) return false;
  const std::vector<EquationRemainder> all = remainders_of(
      first.design, first.x, bench.floor, bench.scan.block_seconds, bench.options.material);
  return std::none_of(all.begin(), all.end(),
                      [](const EquationRemainder& e) { return e.at_least >= e.material; });
}

RefineResult refine_once(std::span<const Model> given, const RefineLogs& logs,
                         const RefineOptions& options) {
  RefineResult result;
  const RefineStage stage = stage_of(given, logs);
  const std::span<const Model> models = stage.models;
  set_inputs(models, logs, result);
  result.elastic_only = stage.elastic_only;
  result.warnings = stage.warnings;
  RefineBench bench{options, stage.wanted, stage.elastic_only};
  bench.scan.threads = options.threads;
  bench.logs = logs.fitted();
  bench.all = bench.logs;
  bench.all.insert(bench.all.end(), logs.test.begin(), logs.test.end());
  const RefineState first = prepare(bench, models, logs, result);
  result.where = ranked(find_regimes(first.design, first.x, bench.floor),
                        find_bands(first.design, first.x, bench.noise.design, bench.noise.fit.x),
                        first.design, first.x, bench.floor);
  const std::vector<TrialRun> runs = trial_runs(first.design);
  report_progress(options, "which effects are separable", 0);
  result.not_separable =
      find_not_separable(first.design, first.x, bench.floor, runs, options.threads);

  Chain chain{first};
  if (!is_immaterial(bench, first)) find_effects(bench, chain, result);
  require_half_explained(chain, result);
  require_one_law(bench, chain, result);
  require_sure_sizes(bench, chain, result);
  const Confirmed confirmed = confirm_on_test(bench, chain, result);
  const std::vector<TestReading>& readings = confirmed.readings;
  RefineState& state = chain.back();
  FinalFit fit = final_fit(bench.n_kept == 0 ? first.design : bench.bare, state.design,
                           state.levels, bench.scan.block_seconds);
  if (state.rho > kRemainder)
    result.unexplained =
        describe_remainder(state.design, fit.x, bench.floor, bench.scan.block_seconds);
  set_remainder(fit.rms, bench.floor, result);
  result.remainders =
      remainders_of(state.design, fit.x, bench.floor, bench.scan.block_seconds, options.material);
  result.material_given = options.material.has_value();
  const TestReading& last = readings.back();
  result.test_remainders = remainders_of(last.rows, last.x, bench.test_floor,
                                         bench.scan.block_seconds, options.material);
  const RefineState before = confirmed.values.of(chain, 0);
  state.x = fit.x;
  const RefineState after = confirmed.values.of(chain, chain.size() - 1);
  take_physical(after.design, bench.scan.block_seconds, state.levels, after.x, fit);
  if (confirmed.values.left()) add_systematic(*confirmed.values.left(), fit);
  if (!add_elongation_errors(after.design, after.x, state.levels, bench, fit))
    result.warnings.emplace_back(kElongationsHeld);
  set_effects(models, named_effects(after.design, fit), result);
  result.shifts = parameter_shifts(first.design, before.x, after.design, fit);
  result.models = refined_models(after.design, fit);
  result.rho_before = first.rho;
  result.rho_after = state.rho;
  set_gaps(bench, chain, readings, result);
  add_inseparable_rivals(result);
  conclude(result);
  if (result.verdict == Verdict::unexplained && !result.unexplained)
    result.unexplained =
        describe_remainder(last.rows, last.x, bench.test_floor, bench.scan.block_seconds);
  choose_next_run({first.design, first.x, bench.floor, bench.first_search.candidates, runs},
                  result);
  if (options.figures)
    result.figures = refine_figures(
        result, {bench.all, first.design, first.x, state.design, state.x, bench.floor},
        {bench.all, readings.front().rows, readings.front().x, readings.back().rows,
         readings.back().x, bench.test_floor},
        {bench.test_logs, bench.compared()});
  return result;
}

/// Of what the models had, the first that is not physical beside what was added; nullptr: none.
const Effect* unphysical(const RefineResult& result) {
  for (const KeptEffect& kept : result.kept) {
    const Effect& row = *kept.now.instance.effect;
    for (std::size_t p = 0; p < row.n_linear(); ++p) {
      const double value = kept.now.instance.parameters[p].value;
      if (value < row.parameters[p].lower || value > row.parameters[p].upper) return &row;
    }
  }
  return nullptr;
}

}  // namespace

namespace {

/// With what the models have, as long as that is physical beside what was added.
RefineResult refine_physically(std::span<const Model> models, const RefineLogs& logs,
                               const RefineOptions& options) {
  std::vector<Model> bases(models.begin(), models.end());
  std::vector<std::string> warnings;
  for (;;) {
    RefineResult result = refine_once(bases, logs, options);
    const Effect* gone = unphysical(result);
    if (gone == nullptr) {
      result.warnings.insert(result.warnings.begin(), warnings.begin(), warnings.end());
      return result;
    }
    warnings.push_back(taken_out(*gone));
    for (Model& model : bases)
      std::erase_if(model.joints.front().added,
                    [gone](const EffectInstance& has) { return has.effect == gone; });
  }
}

}  // namespace

RefineResult refine(std::span<const Model> models, const RefineLogs& logs,
                    const RefineOptions& options) {
  require_bounded_work(logs);
  RefineResult result = models.front().joints.size() > 1
                            ? refine_joints(models, logs, options, refine_physically)
                            : refine_physically(models, logs, options);
  std::vector<std::string> warnings;
  for (const auto* some : {&logs.train, &logs.test, &logs.blocked})
    for (std::string& warning : input_warnings(*some)) warnings.push_back(std::move(warning));
  result.warnings.insert(result.warnings.begin(), warnings.begin(), warnings.end());
  return result;
}

}  // namespace cablefit
