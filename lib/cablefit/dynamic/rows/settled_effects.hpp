// Nonlinear parameters of effects beyond (31): Gauss-Newton on the columns of stage 2.
#pragma once

#include <string>
#include <vector>

#include "cablefit/dynamic/rows/dynamic_job.hpp"

namespace cablefit {

/// Makes the equations of the job and collects their rows. Nonlinear parameters move to the
/// solution of least squares, and the columns are computed again there. This repeats until no
/// parameter moves by more than a tenth of its sd. `warning`: the iteration did not converge.
WindowCounts collect_settled(DynamicJob& job, std::vector<EquationRows>& equations,
                             std::string& warning);

}  // namespace cablefit
