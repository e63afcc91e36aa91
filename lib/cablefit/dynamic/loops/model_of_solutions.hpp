// Converts the solutions of stage 2 to a model that can be simulated.
#pragma once

#include <vector>

#include "cablefit/dynamic/rows/dynamic_job.hpp"
#include "cablefit/model/model.hpp"

namespace cablefit {

/// Model number `which` of the job with the values of `solutions`, one per equation. A parameter
/// that the rows do not determine is 0.
Model model_of_solutions(const DynamicJob& job, const std::vector<EquationRows>& equations,
                         const std::vector<LinearSolution>& solutions, std::size_t which);

}  // namespace cablefit
