// Where the nonlinear parameters of an effect begin when only its name is given.
#pragma once

#include "cablefit/dynamic/rows/dynamic_job.hpp"

namespace cablefit {

/// Gives the job's blank effects start values, one effect after the other: the point of the grid of
/// nonlinear parameters with the smallest residual of least squares on the first windows of the
/// logs.
void find_first_shapes(DynamicJob& job);

}  // namespace cablefit
