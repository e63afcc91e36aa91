#include "cablefit/refine/steps/sure_sizes.hpp"

#include <algorithm>
#include <cmath>

#include "cablefit/refine/rows/refined_model.hpp"
#include "cablefit/refine/steps/elongation_error.hpp"
#include "cablefit/refine/steps/test_reading.hpp"

namespace cablefit {
namespace {

constexpr double kSureSizeSd = 2;

bool is_sure(const Estimate& e) { return e.sd > 0 && std::abs(e.value) > kSureSizeSd * e.sd; }

/// Other cables, whose coefficients are those of the base.
bool has_no_size(const Effect& row) {
  return row.n_linear() == 0 && std::all_of(row.shape.begin(), row.shape.end(),
                                            [](const ShapeGrid& grid) { return grid.is_whole; });
}

/// By its linear coefficients: at which place and speed an effect acts is not its size. One block
/// determines the size of an effect that passes, and there is no sd over blocks.
bool has_sure_size(const NamedEffect& effect) {
  const Effect& row = *effect.instance.effect;
  if (row.passes() || has_no_size(row)) return true;
  const std::vector<Estimate>& all = effect.instance.parameters;
  const bool has_linear = row.n_linear() > 0 && !row.takes_dry_friction;
  const auto end =
      has_linear ? all.begin() + static_cast<std::ptrdiff_t>(row.n_linear()) : all.end();
  return std::any_of(all.begin(), end, is_sure) ||
         std::any_of(effect.derived.begin(), effect.derived.end(), is_sure);
}

}  // namespace

void require_sure_sizes(const RefineBench& bench, Chain& chain, RefineResult& result) {
  while (!result.effects.empty()) {
    const RefineState& last = chain.back();
    const Design& undone = bench.n_kept == 0 ? chain.front().design : bench.bare;
    FinalFit fit = final_fit(undone, last.design, last.levels, bench.scan.block_seconds);
    const std::vector<NamedEffect> alone = named_effects(last.design, fit);
    add_elongation_errors(last.design, fit.x, last.levels, bench, fit);
    const std::vector<NamedEffect> named = named_effects(last.design, fit);
    if (std::all_of(named.end() - static_cast<std::ptrdiff_t>(result.effects.size()), named.end(),
                    has_sure_size))
      return;
    // Later effects were found with the earlier ones in the model.
    const bool goes_with_others = last.is_joint || has_sure_size(named.back());
    const char* const reason = has_sure_size(alone.back())
                                   ? "the error of the searched l_o is as large as its coefficients"
                                   : "none of its coefficients is at least 2 sd";
    drop_last(reason, chain, result);
    while (goes_with_others && !result.effects.empty()) drop_last(reason, chain, result);
    require_half_explained(chain, result);
  }
}

}  // namespace cablefit
