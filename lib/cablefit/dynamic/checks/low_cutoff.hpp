// What a cut-off near the resonance costs: filter and differences then put J_motor off.
#pragma once

#include <string>

#include "cablefit/dynamic/estimates/estimation.hpp"

namespace cablefit {

/// A cut-off from here on, in free resonances, leaves J_motor alone.
inline constexpr double kEnoughResonances = 2;

/// A warning that names J_motor's error by the method (method_floor.hpp), where the cut-off is
/// below twice the resonance and the error is more than half of the sd; else empty. `error`: in the
/// unit of the estimate. `in_sd`: the sd holds it already.
std::string low_cutoff_warning(double cutoff, double resonance, const Estimate& j_motor,
                               double error, bool in_sd);

/// The same for every joint of a fit, into its doubts. Measures the method's floor where the fit
/// has none, as with white sd.
void note_low_cutoff(const EstimationTask& task, const Estimation& estimation, DynamicFit& fit);

}  // namespace cablefit
