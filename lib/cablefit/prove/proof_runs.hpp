// The runs of a proof and their common result. Internal to prove/.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "cablefit/prove/prove.hpp"

namespace cablefit {

/// Streams of random numbers of one run, and of the run with noise alone.
inline constexpr std::uint64_t kDisturbances = 1, kSensors = 2, kStage1 = 3, kCalibration = 4;

/// What a run found; a complaint instead when there is nothing.
struct ProofRun {
  std::vector<Estimate> parameters;
  std::string failure;
};

/// Runs `run` with as many seeds as asked for, side by side, and holds what it finds against
/// `truth`, of which those without an sd are left out. The result does not depend on the threads.
FitProof prove_by_runs(const std::vector<Estimate>& truth, const ProveOptions& options,
                       std::vector<std::string> notes,
                       const std::function<ProofRun(std::uint64_t seed)>& run);

}  // namespace cablefit
