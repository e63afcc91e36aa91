// Several equations with shared parameters in one weighted least squares problem, under linear
// equalities and inequalities: Fichera & Grossard 2017, (26)-(28).
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "cablefit/estimate/fit/least_squares.hpp"
#include "cablefit/estimate/solve/row_statistics.hpp"

namespace cablefit {

/// One equation: residual = rows * (response - regressors x).
struct JointBlock {
  const RowStatistics* rows = nullptr;
  Eigen::MatrixXd regressors;  ///< n_columns x n_params: which columns a parameter multiplies
  Eigen::VectorXd response;    ///< n_columns
  double weight = 1;           ///< of a squared residual, 1/variance
  /// Blocks of one record share their instants (link and motor of one log). Their residuals may be
  /// correlated, so their time cells are joined.
  int record = 0;
};

struct JointProblem {
  std::vector<JointBlock> blocks;
  std::vector<std::string> names;  ///< n_params
  Eigen::MatrixXd equalities;      ///< rows * x = 0, met to rounding; no rows: none
  Eigen::MatrixXd inequalities;    ///< rows * x >= 0; no rows: none

  Eigen::Index n_params() const { return static_cast<Eigen::Index>(names.size()); }
};

struct JointSolution {
  Eigen::VectorXd x;                 ///< of least norm where it is not unique
  std::vector<Eigen::Index> active;  ///< inequalities that hold x, as equalities
  Eigen::MatrixXd solve_operator;    ///< Z (Z'W'W Z)^-1 Z', Z: null space of the (in)equalities
  /// n_params x directions that no row determines, of unit norm after scaling by column_norm.
  Eigen::MatrixXd null_directions;
  Eigen::VectorXd column_norm;                ///< of the stacked, weighted columns
  std::vector<Eigen::VectorXd> combinations;  ///< per block: rows * this = residual
  std::vector<double> rss;                    ///< per block, unweighted
  double weighted_rss = 0;
  Eigen::Index n_rows = 0;
  Eigen::Index n_params = 0;  ///< free: without those that equalities, bounds or rank remove
  double condition_scaled = 0;

  /// Whether the data determine combination * x. `combination`: n_params.
  bool determines(const Eigen::VectorXd& combination) const;
};

/// Stacks the weighted R factors of all blocks, eliminates the equalities by their null space
/// (Golub & Van Loan 2013, 6.2.3) and solves by QR. Rank deficiency is a result.
JointSolution solve(const JointProblem& problem);

/// Sets the blocks' weights to 1/(variance * inflation) of their own residuals; see
/// residual_inflation(). A block without residual keeps its weight.
void reweigh(JointProblem& problem, const JointSolution& solution);

/// Ratio of the covariance of the scores W'rho of one block to that of white residuals of the same
/// size, averaged over the directions that the block determines; at least 1. A block of n
/// correlated rows gets the weight of n / inflation independent rows.
double residual_inflation(const JointBlock& block, const Eigen::VectorXd& combination);

/// 95 % intervals per parameter from the profile of the weighted rss under all equalities and
/// inequalities, with the robust scale (profile_interval.hpp). NaN where nothing is determined.
std::vector<ProfileInterval> joint_profiles(const JointProblem& problem);

struct JointCovariance {
  /// Robust: HAC over the cells of each record, summed over records; never below the white one.
  Eigen::MatrixXd covariance;
  Eigen::MatrixXd white;               ///< for white residuals, each block with its own variance
  Eigen::VectorXd degrees_of_freedom;  ///< per parameter, Welch-Satterthwaite over the records
};
JointCovariance joint_covariance(const JointProblem& problem, const JointSolution& solution);

}  // namespace cablefit
