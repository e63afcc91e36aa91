// Dense least squares of a small matrix with scaled columns. QR gives the solution, singular values
// show how well it is determined.
#pragma once

#include <Eigen/Core>

namespace cablefit {

struct ScaledSolve {
  Eigen::VectorXd x;                ///< of least norm (columns scaled) where it is not unique
  Eigen::MatrixXd inverse;          ///< (A'A)^-1 of the determined directions
  Eigen::MatrixXd null_directions;  ///< p x (p - rank), columns of unit norm, in scaled parameters
  double condition_scaled = 0;      ///< of the columns scaled to unit norm
  double condition = 0;             ///< of the columns as they are
};

/// Columns whose scaled singular value is below this share of the largest are not separable. For
/// measured data, which have at most nine digits ("%.9g").
inline constexpr double kMeasuredRankTolerance = 1e-9;

/// Minimises |a x - b|. a: m x p with m >= p, b: m. p = 0 is allowed.
ScaledSolve solve_scaled(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                         double rank_tolerance = kMeasuredRankTolerance);

}  // namespace cablefit
