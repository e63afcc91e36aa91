#include "cablefit/refine/null/base_draws.hpp"

#include "cablefit/refine/null/kept_effects.hpp"
#include "cablefit/refine/rows/recorded_effects.hpp"
#include "cablefit/refine/rows/refined_model.hpp"
#include "cablefit/refine/search/search.hpp"

namespace cablefit {
namespace {

/// As the simulated logs have them.
Eigen::VectorXd recorded_values(const Design& base, Eigen::VectorXd x) {
  forget_unrecorded(base, x);
  return x;
}

}  // namespace

BaseDraws::BaseDraws(const Design& base, const Eigen::VectorXd& x, std::span<const LogSurvey> logs,
                     const PartFilter& wanted, int threads)
    : models_(recorded_models(models_with(base, x))),
      kept_(base.added),
      smoothing_(base.smoothing),
      x_(recorded_values(base, x)),
      null_(models_, logs, wanted, base.smoothing, threads) {}

Design BaseDraws::design(std::uint64_t seed) const {
  return with_variants(make_design(without_kept(models_), null_.draw(seed), smoothing_), kept_, x_);
}

BaseFit BaseDraws::fitted(std::uint64_t seed, const KindLevels* levels) const {
  return fit_base(design(seed), kAnyBlock, levels);
}

KindLevels BaseDraws::unfitted(std::uint64_t seed) const {
  return rms_of(block_grams(design(seed), kAnyBlock), x_);
}

NullDraw BaseDraws::searched(std::uint64_t seed, const KindLevels& levels,
                             const ScanSettings& settings) const {
  const BaseFit base = fit_base(design(seed), settings.block_seconds, &levels);
  NullDraw out;
  out.floor = base.fit.rms();
  for (const Candidate& candidate :
       scan({base.design, base.grams, base.fit, base.levels}, settings, named_already(base.design)))
    if (candidate.refused.empty()) out.gains[candidate.variant.effect] = candidate.gain;
  return out;
}

}  // namespace cablefit
