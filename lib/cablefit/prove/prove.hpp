// Is the sd of a fit what it promises? The fit is rerun on simulated logs of its own model, whose
// parameters are known: same reference and controller, same length, rate, clock, rounding and
// noise, and disturbance torques as coloured as its residuals (parametric bootstrap, Efron &
// Tibshirani 1993, ch. 6).
#pragma once

#include <functional>
#include <span>

#include "cablefit/dynamic/dynamic_fit.hpp"
#include "cablefit/elastic/elastic_fit.hpp"

namespace cablefit {

struct ProveOptions {
  std::size_t n_runs = 100;
  unsigned long seed = 1;  ///< of the first run; counted up from there
  int threads = 1;         ///< runs at a time; the result does not depend on it
  /// Called from one thread with how many runs are done of how many.
  std::function<void(std::size_t done, std::size_t of)> progress;
};

/// Stage 1 on its way into stage 2.
struct ProveStage1 {
  const ElasticResult* result = nullptr;  ///< nullptr: a rigid drive
  /// Its logs, when they are known: stage 1 is then rerun as well. Else its coefficients are drawn
  /// from their covariance.
  std::span<const LogSurvey> logs;
  ElasticOptions options;
};

/// Fills `proof` of every fit of `result`, which came from fit_dynamic(logs, ...) with `options`,
/// and widens the estimates whose intervals did not cover. A fit that cannot be simulated gets a
/// warning instead.
void prove_dynamic(std::span<const LogSurvey> logs, const ProveStage1& stage1,
                   const DynamicOptions& options, const ProveOptions& prove, DynamicResult& result);

/// The same of stage 1, whose link stands still: the motion is that of the logs, and every fit's
/// elastic torque, friction and offset make the torque that goes with it. `result` came from
/// fit_elastic(logs, options); the runs keep its order and what it took the zero for. f_sm is left
/// out: the copies give it 1 % lower than the log, and why is not known yet.
void prove_elastic(std::span<const LogSurvey> logs, const ElasticOptions& options,
                   const ProveOptions& prove, ElasticResult& result);

}  // namespace cablefit
