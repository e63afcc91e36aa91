// Whether `cablefit dynamic` will take an inertia from a planned motion. Internal to design/.
#pragma once

#include <Eigen/Core>
#include <string>

#include "cablefit/dynamic/rows/dynamic_columns.hpp"

namespace cablefit {

/// Fewer rows per parameter determine nothing.
inline constexpr Eigen::Index kLeastRowsPlanned = 4;

/// Why the inertia of column `own` would be refused on these rows without noise: hardly separable
/// from a torque of position, or dependent on the elastic stage alone. `response`: combination of
/// columns; `value`: of the inertia; `noise`: rms in the rows, N m. Empty: it is accepted.
std::string refusal_of(const Eigen::MatrixXd& rows, const DynamicColumns& columns, Eigen::Index own,
                       const Eigen::VectorXd& response, double value, double noise);

}  // namespace cablefit
