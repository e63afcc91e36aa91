// Linear least squares on RowStatistics: scaled columns, QR, physical bounds, rank reported in
// words, white and robust covariance. With instruments: two-stage least squares.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "cablefit/estimate/solve/motion_advice.hpp"
#include "cablefit/estimate/solve/row_statistics.hpp"
#include "cablefit/estimate/solve/scaled_solve.hpp"

namespace cablefit {

/// Minimises |rows * (response - sum_j regressors[j] x_j)|. Columns of the rows are addressed by
/// index. The response is a combination of columns (tau + Z K, say), so `response` has length
/// n_columns.
struct LinearProblem {
  std::vector<Eigen::Index> regressors;
  std::vector<std::string> names;  ///< one per regressor, for messages
  std::vector<double> lower;       ///< bound per regressor, 0 or -inf; empty: no bounds
  Eigen::VectorXd response;
  /// Per regressor the reason why it is held at 0 ("never taut"); empty: it is estimated.
  std::vector<std::string> held = {};
  /// constraints * x >= 0, a column per regressor; no rows: none.
  Eigen::MatrixXd constraints = {};
  /// Per regressor the part of the motion that it follows, for advice in messages. Regressors
  /// beyond the end get no advice.
  std::vector<MotionColumn> motion = {};
  /// Share of the largest singular value (scaled columns) below which columns are not separable. It
  /// is smaller for data that are exact by definition.
  double rank_tolerance = kMeasuredRankTolerance;
  /// Instruments: columns Z, at least one per estimated regressor. Then |Q'rows * (response - ...)|
  /// is minimised, with Q an orthonormal basis of Z. Without bounds x = (W'P W)^-1 W'P y, P = Z
  /// (Z'Z)^-1 Z'. With as many instruments as regressors this is (Z'W)^-1 Z'y (Wright 1928; Young &
  /// Jakeman 1979; Janot, Vandanjon & Gautier 2014). A regressor without error is its own
  /// instrument. Empty: ordinary least squares.
  std::vector<Eigen::Index> instruments = {};
};

/// Ends of an interval: infinite where the profile never reaches the threshold, NaN where there is
/// no interval.
struct ProfileInterval {
  double low = 0, high = 0;
};

struct LinearSolution {
  Eigen::VectorXd x;                 ///< estimates; 0 where not determined
  Eigen::MatrixXd covariance_white;  ///< the paper's (25), sigma^2 (W'W)^-1
  /// Robust: HAC sandwich over the cells, never below the white one. Without cells the white one.
  Eigen::MatrixXd covariance;
  Eigen::MatrixXd solve_operator;  ///< (W'W)^-1, p x p; 0 rows for fixed or undetermined
  /// n_columns x p: rows * this = What, the regressors W, or their projection P W on the
  /// instruments. x depends on the response by solve_operator What'. With instruments W'W above
  /// means What'What.
  Eigen::MatrixXd score_columns;
  /// Per parameter a share (0..1): of the part of its column that the other regressors do not
  /// explain, the instruments explain so much. It is a partial R^2 (Shea 1997; Godfrey 1999). 1
  /// without instruments.
  Eigen::VectorXd first_stage;
  std::vector<Eigen::Index> instruments;      ///< of the problem
  std::vector<std::string> not_identifiable;  ///< per parameter, empty text when it is determined
  std::vector<bool> at_bound;  ///< at 0, by a bound or by constraints that allow no other value
  /// Rows of problem.constraints that hold the solution. Covariances are then conditional on them,
  /// as if constraints * x = 0 were known for these rows, with n_tied directions fewer.
  std::vector<Eigen::Index> active_constraints;
  Eigen::VectorXd unbounded_x, unbounded_sd;  ///< of the fit without bounds; robust
  /// Where bounds or constraints hold the solution: 95 % intervals per parameter from the profile
  /// of |residual|^2 under them, with the robust scale (profile_interval.hpp). Else empty.
  std::vector<ProfileInterval> profile;
  Eigen::VectorXd residual_combination;  ///< n_columns: rows * this = residual
  double rss = 0;                        ///< sum of squared residuals
  Eigen::Index n_rows = 0;
  int n_tied = 0;                     ///< active constraints between parameters not at a bound
  int n_params = 0;                   ///< determined, not at a bound, not tied
  double condition_scaled = 0;        ///< of the columns scaled to unit norm
  double condition = 0;               ///< of the columns as they are, cond(W)
  double degrees_of_freedom = 0;      ///< for t quantiles
  double effective_rows = 0;          ///< effective sample size
  Eigen::MatrixXd correlation;        ///< of the estimates (white)
  std::vector<std::string> warnings;  ///< hardly_apart() of identifiability.hpp

  double rms() const;
};

/// Rank deficiency and too few rows throw nothing: they are a result, see not_identifiable.
LinearSolution solve(const RowStatistics& rows, const LinearProblem& problem);

/// Largest change of a parameter between two solutions of one problem, in sd of `to`. It measures
/// the convergence of an iteration. 0 where no parameter has an sd.
double largest_change_in_sd(const LinearSolution& from, const LinearSolution& to);

}  // namespace cablefit
