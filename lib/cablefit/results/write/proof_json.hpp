// Coverage of a fit's intervals on simulated logs (--prove). Internal to results/.
#pragma once

#include "cablefit/estimate/tests/fit_proof.hpp"
#include "cablefit/results/write/json_parts.hpp"

namespace cablefit::result_json {

/// "prove" of a fit.
Json proof(const FitProof& proof);

}  // namespace cablefit::result_json
