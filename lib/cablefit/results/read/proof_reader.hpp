// "prove" of a fit in a result file. Internal to results/.
#pragma once

#include <optional>

#include "cablefit/base/json/json_document.hpp"
#include "cablefit/estimate/tests/fit_proof.hpp"

namespace cablefit::result_file {

/// Nothing where the fit was not proved.
std::optional<FitProof> read_proof(const JsonNode& fit);

}  // namespace cablefit::result_file
