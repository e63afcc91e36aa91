// Logs simulated from a base fit, fitted and searched as the logs are: with the columns that the
// base has, those of kept effects among them. Internal to refine/.
#pragma once

#include <span>
#include <vector>

#include "cablefit/refine/null/null_draws.hpp"

namespace cablefit {

class BaseDraws {
 public:
  /// `x`: of all columns of `base`. `threads`: to simulate with now. Throws
  /// Error(not_identifiable) when it cannot be simulated.
  BaseDraws(const Design& base, const Eigen::VectorXd& x, std::span<const LogSurvey> logs,
            const PartFilter& wanted, int threads);

  NullBench& logs() { return null_; }
  const NullBench& logs() const { return null_; }
  /// What is simulated, one per preload.
  const std::vector<Model>& models() const { return models_; }

  /// A draw's base fit: what noise alone leaves, row by row. `levels`: weights; nullptr: of its own
  /// residual.
  BaseFit fitted(std::uint64_t seed, const KindLevels* levels) const;
  /// What the models leave as they are, nothing fitted: the floor of logs that were not fitted.
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
