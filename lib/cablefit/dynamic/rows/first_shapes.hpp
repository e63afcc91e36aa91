// Where the nonlinear parameters of an effect begin when only its name is given.
#pragma once

#include "cablefit/dynamic/rows/dynamic_job.hpp"

namespace cablefit {

/// An effect by its name alone: all its values are NaN.
RefinementInstance blank_effect(const Refinement& row);

/// Gives the job's blank effects values to begin with, one effect after the other: of the points of
/// its grid of nonlinear parameters the one with which least squares leaves least on the first
/// windows of the logs.
void find_first_shapes(DynamicJob& job);

}  // namespace cablefit
