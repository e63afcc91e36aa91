// Coverage of a fit's intervals on simulated logs (--prove), for tables and JSON. Internal to
// report/.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "cablefit/estimate/tests/fit_proof.hpp"
#include "cablefit/report/documents/document.hpp"

namespace cablefit {

/// `what`: which fit, "low, poly by wls".
Table proof_table(const std::string& what, const FitProof& proof);

nlohmann::ordered_json proof_json(const FitProof& proof);

}  // namespace cablefit
