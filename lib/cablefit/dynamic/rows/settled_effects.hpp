// Nonlinear parameters of effects beyond (31): Gauss-Newton on the columns of stage 2.
#pragma once

#include <string>
#include <vector>

#include "cablefit/dynamic/rows/dynamic_job.hpp"

namespace cablefit {

/// Makes the equations of the job and collects their rows. Where effects have nonlinear parameters,
/// the columns are made anew about what least squares finds (of the first model), until no such
/// parameter moves by more than a tenth of its sd. `warning`: that they still move in the end.
WindowCounts collect_settled(DynamicJob& job, std::vector<EquationRows>& equations,
                             std::string& warning);

}  // namespace cablefit
