// Logs of one preload that have an encoder zero each, as where the axes were homed anew before
// every log: one zero for all then looks like a loop that no static law explains.
#pragma once

#include <span>

#include "cablefit/elastic/elastic_result.hpp"
#include "cablefit/elastic/models/candidates.hpp"

namespace cablefit {

/// Warns where zeros of their own explain most of what the selected fit leaves, with the zeros
/// (mrad; mm on a linear axis): one curve for all logs, fitted by two Gauss-Newton steps from the
/// selected one. `rows`: of all logs together; `candidates`: those of preload.fits. Returns what is
/// left with these zeros, or else by the selected fit: rms, N m (N).
double note_log_zeros(const ElasticJob& job, const BlockedRows& rows,
                      std::span<const ElasticCandidate> candidates, ElasticPreload& preload);

}  // namespace cablefit
