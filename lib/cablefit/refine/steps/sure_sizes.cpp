#include "cablefit/refine/steps/sure_sizes.hpp"

#include <algorithm>
#include <cmath>

#include "cablefit/refine/rows/refined_model.hpp"
#include "cablefit/refine/steps/elongation_error.hpp"
#include "cablefit/refine/steps/test_reading.hpp"

namespace cablefit {
namespace {

constexpr double kSureSd = 2;

bool is_sure(const Estimate& e) { return e.sd > 0 && std::abs(e.value) > kSureSd * e.sd; }

/// By its linear coefficients; where and how fast it acts says nothing of how large it is. Of what
/// passes one block tells the size, and no sd over blocks.
bool has_sure_size(const NamedEffect& effect) {
  const Effect& row = *effect.instance.effect;
  if (row.passes()) return true;
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
    add_elongation_errors(last.design, fit.x, last.levels, bench, fit);
    const std::vector<NamedEffect> named = named_effects(last.design, fit);
    if (std::all_of(named.end() - static_cast<std::ptrdiff_t>(result.effects.size()), named.end(),
                    has_sure_size))
      return;
    // Later effects were found with the earlier ones in the model.
    const bool goes_with_others = last.is_joint || has_sure_size(named.back());
    const char* const reason =
        bench.options.elongations.empty()
            ? "none of its coefficients is at least 2 sd"
            : "the error of the searched l_o is as large as its coefficients";
    drop_last(reason, chain, result);
    while (goes_with_others && !result.effects.empty()) drop_last(reason, chain, result);
    require_half_explained(chain, result);
  }
}

}  // namespace cablefit
