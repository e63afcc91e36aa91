// Directions that linear equalities leave free. Internal to estimate/.
#pragma once

#include <Eigen/Core>

namespace cablefit {

/// Orthonormal columns z with rows * z = 0; the identity when there are no rows. Rows of unit norm,
/// or of rounding beside others: what is below 1e-12 of them says nothing new.
Eigen::MatrixXd null_space(const Eigen::MatrixXd& rows);

}  // namespace cablefit
