// Do the 95 % intervals of a fit contain the truth? Fits to simulated logs with known parameters
// test that.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "cablefit/base/parameter.hpp"

namespace cablefit {

/// Confidence interval of a counted share: Wilson's score interval (Wilson 1927, JASA 22:209),
/// which keeps its level near 1 too.
struct ShareBand {
  double low = 0, high = 1;
};
/// `hits` of `n_trials` > 0; `z`: normal quantile, 1.96 for 95 %, 3.29 for 99.9 %.
ShareBand share_band(std::size_t hits, std::size_t n_trials, double z = 1.959963984540054);

/// One parameter over the runs of a proof. All but the last fields are in the parameter's unit.
struct ProvedParameter {
  std::string name, unit;
  double truth = 0;           ///< the value that the logs were simulated with
  double bias = 0;            ///< mean of the estimates minus the truth
  double standard_error = 0;  ///< of the bias: scatter / sqrt(n_runs)
  double scatter = 0;         ///< sd of the estimates
  double mean_sd = 0;         ///< mean of the sd that the runs report
  std::size_t n_runs = 0;     ///< runs that determined it
  std::size_t n_covered = 0;  ///< runs whose 95 % interval contains the truth
  ShareBand coverage_band;    ///< 95 % band of the coverage
  double factor = 1;          ///< factor >= 1 on sd and interval that makes the intervals cover
  std::string verdict;        ///< "covers", "too narrow: ..."; also states a bias
  std::size_t n_open = 0;     ///< runs that ended without a value of it

  double coverage() const {
    return n_runs > 0 ? static_cast<double>(n_covered) / static_cast<double>(n_runs) : 0;
  }
};

/// `estimates`: one per run that ended; `n_open` counts those without a value. The intervals are
/// too narrow when the band of their coverage ends below 95 %. The factor is then the one that
/// would make them cover, from the order statistics of |estimate - truth| / half width (split
/// conformal prediction, Vovk et al. 2005: the ceil(0.95 (n + 1))-th smallest).
ProvedParameter judge_runs(const Estimate& truth, std::span<const Estimate> estimates);

/// Result of refits to simulated logs of the fitted model.
struct FitProof {
  std::size_t n_runs = 0;    ///< requested
  std::size_t n_failed = 0;  ///< runs that ended with an error instead of estimates
  std::string first_failure;
  unsigned long seed = 0;  ///< of the first run; each later run adds 1
  std::vector<ProvedParameter> parameters;
  std::string verdict;
  std::vector<std::string> notes;  ///< simulated: controller, noise, disturbances
};

/// Multiplies sd and interval of each estimate that did not cover by its factor. An interval that
/// ends at a bound grows upwards only.
void widen(std::vector<Estimate>& estimates, const FitProof& proof);

}  // namespace cablefit
