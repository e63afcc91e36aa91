// Do the 95 % intervals of a fit contain the truth? Tested by fits to logs of known parameters.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "cablefit/base/parameter.hpp"

namespace cablefit {

/// Interval of a share that was counted: Wilson's score interval (Wilson 1927, JASA 22:209), which
/// keeps its level for shares near 1 too.
struct ShareBand {
  double low = 0, high = 1;
};
/// `hits` of `n_trials` > 0; `z`: normal quantile, 1.96 for 95 %, 3.29 for 99.9 %.
ShareBand share_band(std::size_t hits, std::size_t n_trials, double z = 1.959963984540054);

/// One parameter over the runs of a proof, all but the last of them in the parameter's unit.
struct ProvedParameter {
  std::string name, unit;
  double truth = 0;           ///< the value that the logs were simulated with
  double bias = 0;            ///< mean of the estimates minus the truth
  double standard_error = 0;  ///< of the bias: scatter / sqrt(n_runs)
  double scatter = 0;         ///< sd of the estimates
  double mean_sd = 0;         ///< of the sd of the runs
  std::size_t n_runs = 0;     ///< that determined it
  std::size_t n_covered = 0;  ///< whose 95 % interval holds the truth
  ShareBand coverage_band;    ///< 95 % band of the coverage
  double factor = 1;          ///< that sd and interval have to be multiplied with to cover, >= 1
  std::string verdict;        ///< "covers", "too narrow: ...", also about bias

  double coverage() const {
    return n_runs > 0 ? static_cast<double>(n_covered) / static_cast<double>(n_runs) : 0;
  }
};

/// `estimates`: one per run, those without a number are not counted. The intervals count as too
/// narrow when their coverage's band ends below 95 %; the factor is then the one that would have
/// made them cover, from the order statistics of |estimate - truth| / half width (split conformal
/// prediction, Vovk et al. 2005: the ceil(0.95 (n + 1))-th smallest).
ProvedParameter judge_runs(const Estimate& truth, std::span<const Estimate> estimates);

/// Result of refits to simulated logs of the fitted model.
struct FitProof {
  std::size_t n_runs = 0;    ///< asked for
  std::size_t n_failed = 0;  ///< that ended with an error instead of numbers
  std::string first_failure;
  unsigned long seed = 0;  ///< of the first run; counted up from there
  std::vector<ProvedParameter> parameters;
  std::string verdict;
  std::vector<std::string> notes;  ///< what was simulated: controller, noise, disturbances
};

/// Multiplies sd and interval of the estimates that did not cover with their factor. An interval at
/// a bound, or cut off there, grows upwards.
void widen(std::vector<Estimate>& estimates, const FitProof& proof);

}  // namespace cablefit
