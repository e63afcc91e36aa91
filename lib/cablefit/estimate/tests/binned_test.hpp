// Does what a fit leaves depend on a variable? Means over bins of it, judged together with a
// covariance that holds for correlated residuals.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace cablefit {

struct BinnedTestResult {
  double f = 0, dof_1 = 0, dof_2 = 0;
  double p_value = 1;
  /// Root mean square over the rows of what the bins explain, less what noise would: >= 0.
  double structure = 0;
  /// The least structure that noise would not hide, twice its own sd over the bins.
  double detectable = 0;
  double explained = 0;  ///< 0..1, of the rows' squares by the means of the bins, noise included
  double largest = 0, largest_at = 0;  ///< mean of the bin farthest from 0, mean variable there
  /// False: the regressors explain every difference between bins, or there are too few rows.
  bool is_possible = false;
};

/// Inner edges of at most `n_bins` bins with about as many values each, ascending; a few levels get
/// a bin each. NaN is left out. Empty: all values are alike.
std::vector<double> bin_edges(std::vector<double> values, std::size_t n_bins);
/// 0 .. edges.size(): a value on an edge belongs to the bin above it.
std::size_t bin_of(double value, const std::vector<double>& edges);

/// Length of a stretch in places of the time grid, for rows numbered up to `last`: at least 1, and
/// at most 1024 stretches.
Eigen::Index stretch_places(Eigen::Index last);

/// F-test of zero means of a residual in all bins of a variable. The bins' scores, sums of the
/// residual, are turned so that white residuals would give them a unit matrix, and their covariance
/// is long_run_covariance() over stretches of time: F = W (nu - k + 1)/(nu k) with nu its degrees
/// of freedom (Hotelling 1931).
class BinnedTest {
 public:
  /// `edges`: of bin_edges(), not empty. `cell_places`: see stretch_places().
  BinnedTest(std::vector<double> edges, Eigen::Index n_regressors, Eigen::Index cell_places);

  /// Consecutive rows: places on the time grid, variable (rows with NaN are left out), residual,
  /// regressors of the fit (n x n_regressors).
  void add(std::span<const Eigen::Index> numbers, const Eigen::Ref<const Eigen::VectorXd>& variable,
           const Eigen::Ref<const Eigen::VectorXd>& residual,
           const Eigen::Ref<const Eigen::MatrixXd>& regressors);

  /// The rows are those of the fit: the scores are freed of what its regressors explain, as those
  /// of a Lagrange multiplier test (Breusch & Pagan 1980).
  BinnedTestResult of_fitted_rows() const;
  /// They are others: the error of the parameters, with this covariance, moves the means too.
  BinnedTestResult of_unseen_rows(const Eigen::MatrixXd& parameter_covariance) const;

 private:
  struct Cell {
    Eigen::Index id = 0;
    Eigen::VectorXd bins, regressors;  ///< sums of residual times indicator, times regressor
  };
  Cell& cell_at(Eigen::Index number);
  /// `own`: bins x regressors, what of the regressors' scores to take off those of the bins.
  BinnedTestResult judged(const Eigen::MatrixXd& own, const Eigen::MatrixXd& white,
                          const Eigen::MatrixXd& extra) const;

  std::vector<double> edges_;
  Eigen::Index n_bins_, cell_places_;
  std::vector<Cell> cells_;
  Eigen::VectorXd rows_in_bin_, variable_in_bin_;
  double squares_ = 0;     ///< of the residual
  Eigen::MatrixXd cross_;  ///< bins x regressors
  Eigen::MatrixXd gram_;   ///< regressors x regressors
};

}  // namespace cablefit
