// What no residual shows of an estimate's error, as part of its sd.
#pragma once

#include "cablefit/dynamic/estimates/estimation.hpp"

namespace cablefit {

/// Measures the method's floor (method_floor.hpp), or takes it from the job's options, and adds it
/// and the fit's `estimator_difference` to sd and interval of every parameter, in squares. Says in
/// the decisions of which it is a tenth of the variance. Nothing where white sd are asked for.
void add_systematic(const EstimationTask& task, bool by_filtered_rows, Estimation& estimation);

/// The floor alone, as an sd by parameter; empty: it cannot be measured. `note`: how it was, or why
/// it was not.
std::map<std::string, double> measured_floor(const EstimationTask& task,
                                             const Estimation& estimation,
                                             std::string* note = nullptr);

}  // namespace cablefit
