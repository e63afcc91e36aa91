#include "cablefit/refine/steps/test_reading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/refine/gap_levels.hpp"
#include "cablefit/refine/null/kept_effects.hpp"
#include "cablefit/refine/rows/physical_values.hpp"
#include "cablefit/refine/rows/refined_model.hpp"
#include "cablefit/refine/steps/fit_bias.hpp"
#include "cablefit/refine/verdict/agreement.hpp"
#include "cablefit/refine/verdict/conclusion.hpp"

namespace cablefit {
namespace {

/// Whether the test logs can show a dated effect. Of an event in the last training log nobody knows
/// whether it is still there.
bool can_show(const RefineBench& bench, const Variant& variant) {
  const bool is_held_out = bench.held_back > 0;
  return is_held_out || (!variant.ends_with_log && variant.event_log + 1 < bench.logs.size());
}

/// As the test logs are: without what they cannot show.
Design as_tested(const RefineBench& bench, Design design) {
  for (Variant& variant : design.added)
    if (variant.effect->is_event && !can_show(bench, variant)) variant.ends_with_log = true;
  return design;
}

std::string_view name_of_test(const RefineBench& bench) {
  return bench.held_back > 0 ? "the last third of the logs" : "the test logs";
}

TestReading read_test(const RefineBench& bench, const RefineState& state) {
  const double seconds = bench.scan.block_seconds;
  const Design design = as_tested(bench, state.design);
  TestReading reading;
  reading.x = physical_values(state.design, seconds, state.levels, state.x);
  const std::vector<Model> models = models_with(design, reading.x);
  reading.rows = design_like(design, reading.x, models, bench.test);
  reading.gap = gap_of(reading.rows, reading.x, bench.test_floor, seconds);
  reading.simulated = bench.simulated(models);
  return reading;
}

double sd_better(const RefineBench& bench, const KindLevels& levels, const TestReading& before,
                 const TestReading& after) {
  const auto error = [&](const TestReading& reading) {
    return gap_of(block_grams(reading.rows, bench.scan.block_seconds), reading.x, levels).squares;
  };
  return paired(error(before), error(after)).in_sd();
}

/// Reason of the test logs against what distinguishes two states; empty: none.
std::string why_not_confirmed(const RefineBench& bench, const Chain& chain,
                              const std::vector<TestReading>& readings, std::size_t from,
                              std::size_t to) {
  const RefineState &before = chain[from], &after = chain[to];
  const Variant& variant = after.design.added.back();
  const HeldOutChange change{*variant.effect,
                             readings[from].gap.rho,
                             readings[to].gap.rho,
                             after.rho > kRemainder,
                             sd_better(bench, after.levels, readings[from], readings[to]),
                             variant.effect->lasts() && can_show(bench, variant),
                             (before.rho - after.rho) / std::max(1e-9, before.rho - 1),
                             0,
                             kUnbounded,
                             name_of_test(bench)};
  std::string reason = why_not_added(change);
  if (!reason.empty() || variant.effect->is_event) return reason;
  const std::string simulated =
      why_not_simulated(readings[from].simulated, readings[to].simulated, bench.simulation_floor);
  return simulated.empty() ? "" : fmt::format("on {} {}", name_of_test(bench), simulated);
}

bool has_event(const RefineState& state, std::size_t n_effects) {
  const std::vector<Variant>& added = state.design.added;
  return std::any_of(added.end() - static_cast<std::ptrdiff_t>(n_effects), added.end(),
                     [](const Variant& variant) { return variant.effect->is_event; });
}

RefineStep& last_accepted(RefineResult& result) {
  return *std::find_if(result.steps.rbegin(), result.steps.rend(),
                       [](const RefineStep& step) { return step.accepted; });
}

}  // namespace

void drop_last(const std::string& reason, Chain& chain, RefineResult& result) {
  RefineStep& step = last_accepted(result);
  step.accepted = false;
  step.reason = reason;
  result.effects.pop_back();
  chain.pop_back();
}

namespace {

void drop_all(const std::string& reason, Chain& chain, RefineResult& result) {
  while (!result.effects.empty()) drop_last(reason, chain, result);
}

/// "it closes 30 % of the squared gap of ...; at least half is required", or empty.
std::string too_little(const Gaps& gaps, std::size_t n_effects, std::string_view data) {
  const double share = closed_share(gaps);
  if (share >= kLeastClosed) return "";
  return fmt::format("{} {:.0f} % of the squared gap of {}; at least half is required",
                     n_effects > 1 ? "all effects together close" : "it closes",
                     100 * std::max(0.0, share), shows_gap(gaps) ? data : "the training samples");
}

/// What the readings show of accepted steps and of the effects that are left.
void add_steps(const RefineBench& bench, const std::vector<TestReading>& readings,
               RefineResult& result) {
  std::size_t at = 0;
  for (RefineStep& step : result.steps)
    if (step.accepted) step.gap_test = bench.test_unit() * std::sqrt(readings[++at].gap.rho);
}

void add_gains(const RefineBench& bench, const Chain& chain,
               const std::vector<TestReading>& readings, RefineResult& result) {
  for (std::size_t k = 0; k < result.effects.size(); ++k) {
    const Variant& variant = chain[k + 1].design.added.back();
    const bool is_shown = !variant.effect->is_event || can_show(bench, variant);
    const bool visible = is_shown && readings[k].gap.rho > kVisibleGap;
    const double from = visible ? readings[k].gap.rho : chain[k].rho;
    const double to = visible ? readings[k + 1].gap.rho : chain[k + 1].rho;
    result.effects[k].evidence.gain = from > 1 ? (from - to) / (from - 1) : 0;
  }
}

/// Reason of the test logs against the last effect, or against all of them; empty: none.
std::string why_not_last(const RefineBench& bench, const Chain& chain,
                         const std::vector<TestReading>& readings) {
  const std::size_t last = chain.size() - 1;
  const std::size_t before = chain[last].is_joint ? last - 2 : last - 1;
  const std::string reason = why_not_confirmed(bench, chain, readings, before, last);
  return reason.empty() && before > 0 ? why_not_confirmed(bench, chain, readings, 0, last) : reason;
}

}  // namespace

ReportedValues::ReportedValues(const RefineBench& bench, const Chain& chain) {
  for (std::size_t k = 0; k < chain.size(); ++k)
    biases_.push_back(k == 0 ? std::optional(bench.base_bias) : fit_bias(bench, chain[k]));
  const auto& last = biases_.back();
  if (last && simulates_better_without(bench, chain.back(), *last)) return;
  left_ = last;
  biases_.clear();
}

RefineState ReportedValues::of(const Chain& chain, std::size_t k) const {
  const bool is_biased = k < biases_.size() && biases_[k];
  return is_biased ? without_bias(chain[k], *biases_[k]) : chain[k];
}

void require_half_explained(Chain& chain, RefineResult& result) {
  const std::size_t n = result.effects.size();
  if (n == 0) return;
  const RefineState &first = chain.front(), &last = chain.back();
  const std::string reason =
      too_little({first.rho, last.rho, first.held_out.rho, last.held_out.rho, has_event(last, n)},
                 n, "held-out blocks");
  if (!reason.empty()) drop_all(reason, chain, result);
}

void require_one_law(const RefineBench& bench, Chain& chain, RefineResult& result) {
  const auto why_not = [&](std::size_t effect) {
    const RefineState& last = chain.back();
    return why_not_one_law(last.design, last.x, last.levels, bench.n_kept + effect,
                           bench.scan.block_seconds);
  };
  while (!result.effects.empty()) {
    const std::string reason = why_not(result.effects.size() - 1);
    if (reason.empty()) break;
    const bool is_joint = chain.back().is_joint;
    drop_last(reason, chain, result);
    if (is_joint) drop_last(reason, chain, result);
    require_half_explained(chain, result);
  }
  for (std::size_t k = 0; k + 1 < result.effects.size(); ++k) {
    const std::string reason = why_not(k);
    if (!reason.empty()) drop_all(reason, chain, result);
  }
}

Confirmed confirm_on_test(const RefineBench& bench, Chain& chain, RefineResult& result) {
  for (;;) {
    Confirmed now{ReportedValues(bench, chain), {}};
    for (std::size_t k = 0; k < chain.size(); ++k)
      now.readings.push_back(read_test(bench, now.values.of(chain, k)));
    add_steps(bench, now.readings, result);
    const std::size_t n = result.effects.size();
    if (n == 0) return now;
    const std::string reason = why_not_last(bench, chain, now.readings);
    if (!reason.empty()) {
      const bool is_joint = chain.back().is_joint;
      drop_last(reason, chain, result);
      if (is_joint) drop_last(reason, chain, result);
      require_half_explained(chain, result);
      continue;
    }
    const std::string little =
        too_little({chain.front().rho, chain.back().rho, now.readings.front().gap.rho,
                    now.readings.back().gap.rho, has_event(chain.back(), n)},
                   n, name_of_test(bench));
    if (little.empty()) {
      add_gains(bench, chain, now.readings, result);
      return now;
    }
    drop_all(little, chain, result);
  }
}

}  // namespace cablefit
