// Errors of an estimate that no residual shows, as part of its sd.
#pragma once

#include "cablefit/dynamic/estimates/estimation.hpp"

namespace cablefit {

/// Measures the method's floor (method_floor.hpp), or takes it from the job's options. Adds it and
/// the fit's `estimator_difference` to sd and interval of every parameter, in squares. The
/// decisions list the parameters for which they are a tenth of the variance. Does nothing where
/// white sd are requested.
void add_systematic(const EstimationTask& task, bool by_filtered_rows, Estimation& estimation);

/// The floor alone, as an sd by parameter; empty: it cannot be measured. `note`: how it was
/// measured, or why not.
std::map<std::string, double> measured_floor(const EstimationTask& task,
                                             const Estimation& estimation,
                                             std::string* note = nullptr);

}  // namespace cablefit
