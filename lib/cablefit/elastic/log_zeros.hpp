// Logs of one preload that have an encoder zero each, as where the axes were homed anew before
// every log: one zero for all then looks like a loop that no static law explains.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cablefit/elastic/candidates.hpp"
#include "cablefit/elastic/elastic_result.hpp"

namespace cablefit {

struct LogZeros {
  struct Zero {
    std::string log;     ///< path
    double theta_0 = 0;  ///< rad (m on a linear axis)
  };
  std::vector<Zero> zeros;  ///< in the order of the logs
  double rms = 0;           ///< what is left with a zero per log, N m (N)
};

/// `candidate` with one curve for all logs and a zero for each; nothing for a single log, or where
/// the rows do not tell. `rows`: of all logs; `fitted`: with one zero for all.
std::optional<LogZeros> find_log_zeros(const ElasticJob& job, const BlockedRows& rows,
                                       const ElasticCandidate& candidate,
                                       const Transmission& fitted);

/// Warns where zeros of their own explain most of what the selected fit leaves. What is left then,
/// or of that fit, N m rms (N).
double note_log_zeros(const ElasticJob& job, const BlockedRows& rows,
                      std::span<const ElasticCandidate> candidates, ElasticPreload& preload);

}  // namespace cablefit
