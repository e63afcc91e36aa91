// Error of J_motor when the cut-off is near the resonance, caused by filter and differences.
#pragma once

#include <string>

#include "cablefit/dynamic/estimates/estimation.hpp"

namespace cablefit {

/// From this cut-off on, in free resonances, the filter does not change J_motor.
inline constexpr double kEnoughResonances = 2;

/// A warning with J_motor's error by the method (method_floor.hpp), where the cut-off is below
/// twice the resonance and the error is more than half of the sd; else empty. `error`: in the unit
/// of the estimate. `in_sd`: the sd includes it.
std::string low_cutoff_warning(double cutoff, double resonance, const Estimate& j_motor,
                               double error, bool in_sd);

/// Adds this warning for every joint of a fit to its doubts. Measures the method's floor where the
/// fit has none, as with white sd.
void note_low_cutoff(const EstimationTask& task, const Estimation& estimation, DynamicFit& fit);

}  // namespace cablefit
