// Start values of an effect's nonlinear parameters when only its name is given.
#pragma once

#include "cablefit/dynamic/rows/dynamic_job.hpp"

namespace cablefit {

/// Gives the job's effects without values start values, one effect after the other: the grid point
/// of the nonlinear parameters with the smallest least-squares residual on the first windows of the
/// logs.
void find_first_shapes(DynamicJob& job);

/// Without those that have no values yet.
EffectsPerJoint with_values(EffectsPerJoint effects);

}  // namespace cablefit
