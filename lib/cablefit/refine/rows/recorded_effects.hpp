// Which effects a recorder of the simulated model would see too: not what happened once, and not
// what is wrong with the recorder. Internal to refine/.
#pragma once

#include <vector>

#include "cablefit/refine/rows/design.hpp"

namespace cablefit {

/// The models without those that it would not.
std::vector<Model> recorded_models(std::vector<Model> models);

/// Whether it would see this one.
bool is_recorded(const Effect& row);
inline bool is_unrecorded(const Effect& row) { return !is_recorded(row); }

/// Sets what belongs to the columns of those to 0. `x`: of all columns.
void forget_unrecorded(const Design& design, Eigen::VectorXd& x);

}  // namespace cablefit
