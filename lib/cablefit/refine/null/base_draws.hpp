// Logs simulated from a base fit, then fitted and searched like the real logs: with the columns of
// the base, including those of kept effects. Internal to refine/.
#pragma once

#include <span>
#include <vector>

#include "cablefit/refine/null/null_draws.hpp"

namespace cablefit {

class BaseDraws {
 public:
  /// `x`: of all columns of `base`. `threads`: for the simulation of the base here. Throws
  /// Error(not_identifiable) when the base cannot be simulated.
  BaseDraws(const Design& base, const Eigen::VectorXd& x, std::span<const LogSurvey> logs,
            const PartFilter& wanted, int threads);

  NullBench& logs() { return null_; }
  const NullBench& logs() const { return null_; }
  /// The simulated models, one per preload.
  const std::vector<Model>& models() const { return models_; }

  /// The base fit of a draw: its residual is noise alone, row by row. `levels`: weights; nullptr:
  /// those of its own residual.
  BaseFit fitted(std::uint64_t seed, const KindLevels* levels) const;
  /// Residual of the models without a fit: the floor of logs that were not fitted.
  KindLevels unfitted(std::uint64_t seed) const;
  NullDraw searched(std::uint64_t seed, const KindLevels& levels,
                    const ScanSettings& settings) const;

 private:
  Design design(std::uint64_t seed) const;

  std::vector<Model> models_;
  std::vector<Variant> kept_;
  Smoothing smoothing_;
  Eigen::VectorXd x_;
  NullBench null_;
};

}  // namespace cablefit
