// Coverage of a fit's intervals on simulated logs (--prove), as a table. Internal to report/.
#pragma once

#include <string>

#include "cablefit/estimate/tests/fit_proof.hpp"
#include "cablefit/report/parts/document.hpp"

namespace cablefit {

/// `what`: which fit, "low, poly by wls".
Table proof_table(const std::string& what, const FitProof& proof);

}  // namespace cablefit
