// Nonlinear least squares with bounds, and how well its minimum is determined.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "cablefit/estimate/solve/scaled_solve.hpp"

namespace cablefit {

/// Minimise |r(x)|^2 over lower <= x <= upper.
struct NonlinearProblem {
  std::vector<std::string> names;  ///< one per parameter, for messages
  Eigen::VectorXd start;           ///< p, within the bounds
  Eigen::VectorXd lower, upper;    ///< p, -inf and inf: none; empty: no bounds at all
  /// Typical size of each parameter, p; empty: |start|, or 1 where that is 0.
  Eigen::VectorXd scale;
  Eigen::Index n_residuals = 0;
  /// Fills r (n_residuals) and, unless it is null, its Jacobian (n_residuals x p). False: r has no
  /// value at x, and the step that led there is taken back. A sum over very many rows may be given
  /// compressed: with [J r] = Q R, R itself is a residual of p + 1 rows with the same minimum.
  std::function<bool(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd* jacobian)>
      evaluate;
  /// `evaluate` gets the Jacobian at little extra cost: it is asked for both at once.
  bool jacobian_is_cheap = false;
  double rank_tolerance = kMeasuredRankTolerance;  ///< see LinearProblem
};

struct NonlinearOptions {
  int max_iterations = 200;
  /// Stops when a step lowers |r|^2 by less than this share.
  double function_tolerance = 1e-12;
  /// Stops when a step is shorter than this, relative to x (scaled).
  double parameter_tolerance = 1e-12;
  /// Stops when a Gauss-Newton step would lower |r|^2 by less than this, or four steps in a row
  /// have not lowered it; with r whitened, d^2 p is a step of d sd. 0: never.
  double decrement_tolerance = 0;
  /// Searches along steps that bounds cut short, and begins again with shorter first steps where it
  /// ends at a point that is flat or without rank: right far from the minimum, and a waste of
  /// costly evaluations near it.
  bool thorough = true;
};

struct NonlinearSolution {
  Eigen::VectorXd x;
  double rss = 0;  ///< |r|^2
  bool converged = false;
  std::string message;  ///< how it ended, in words
  int n_evaluations = 0;
  double decrement = 0;   ///< |r|^2 that one more Gauss-Newton step would take away
  Eigen::Index rank = 0;  ///< of the Jacobian of the parameters that are not on a bound
  /// (J'J)^-1 of what is determined and not on a bound, by QR with scaled columns; times the
  /// variance of r it is the covariance of x. p x p.
  Eigen::MatrixXd inverse;
  double condition_scaled = 0;
  bool is_flat = false;                       ///< hardly depends on some parameter at x
  std::vector<std::string> not_identifiable;  ///< per parameter why, empty when it is determined
  std::vector<bool> at_bound;
};

/// Levenberg-Marquardt in a trust region (Ceres; More 1978), parameters scaled, one thread, the
/// same bits every time. A solve that does not converge is a result, described in `message`. Throws
/// nothing of its own.
NonlinearSolution solve(const NonlinearProblem& problem, const NonlinearOptions& options = {});

}  // namespace cablefit
