// Least squares with inequalities: small dense problems with a handful of parameters. Debian's
// Eigen 3.4 has no solver for them, and Ceres knows bounds only.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace cablefit {

/// Of a singular value over the largest, with constraints, without, and of instruments. Below it,
/// data with nine digits in double precision determine nothing.
inline constexpr double kRankTolerance = 1e-9;

/// Minimises |a u - b| over u >= 0: algorithm NNLS of Lawson & Hanson 1974, ch. 23. `a`: m x n, its
/// columns need not be scaled; b: m. Deterministic; each step lowers |a u - b|, so that no set of
/// positive u comes back and it ends.
Eigen::VectorXd non_negative_least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

struct ConstrainedSolution {
  Eigen::VectorXd x;  ///< of least norm (columns of `a` scaled) where it is not unique
  std::vector<Eigen::Index> active;  ///< rows of g that hold it: g_i x = 0 and multiplier_i > 0
  Eigen::VectorXd multipliers;       ///< one per row of g, >= 0: a'(a x - b) = g' multipliers
};

/// Minimises |a x - b| subject to g x >= 0. a: m x p, b: m, g: any number of rows x p; x = 0 always
/// satisfies it. In coordinates w with |a x - b| = |w - c| + constant the solution is the
/// projection of c onto a cone, c + B' u, and u solves the dual, min |B' u + c| over u >= 0 (Moreau
/// 1962; Lawson & Hanson 1974, ch. 23, problem LDP, for homogeneous inequalities). Directions that
/// `a` does not determine stay out. The active rows are linearly independent.
ConstrainedSolution constrained_least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                                              const Eigen::MatrixXd& g);

}  // namespace cablefit
