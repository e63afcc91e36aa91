// Effects that a recorder of the simulated model would record too. Events and errors of the
// recorder itself are not among them. Internal to refine/.
#pragma once

#include <vector>

#include "cablefit/refine/rows/design.hpp"

namespace cablefit {

/// The models with recorded effects only.
std::vector<Model> recorded_models(std::vector<Model> models);

/// Whether a recorder records this effect.
bool is_recorded(const Effect& row);
inline bool is_unrecorded(const Effect& row) { return !is_recorded(row); }

/// Sets the values of columns of unrecorded effects to 0. `x`: of all columns.
void forget_unrecorded(const Design& design, Eigen::VectorXd& x);

}  // namespace cablefit
