// The largest residual of a fit from the very pass that collects its rows, although the fit is
// known only afterwards.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "cablefit/estimate/solve/row_statistics.hpp"

namespace cablefit {

/// Keeps, batch by batch, the few rows whose residual is largest for a guess of the fit, and how
/// large each column gets. With the final fit the largest residual among the kept rows is that of
/// all rows if no other row can have come past it: a row's residual moves by no more than the sum
/// over columns of |change of the combination| times the column's largest value.
class ResidualPeaks {
 public:
  /// n_columns x fits: rows * guesses = residuals, nearly. No columns: nothing is kept.
  explicit ResidualPeaks(Eigen::MatrixXd guesses);
  /// For another thread or window.
  ResidualPeaks empty_copy() const { return ResidualPeaks(guesses_); }

  void add(const Rows& rows);
  void add(ResidualPeaks&& later);

  /// Largest |rows * combination| over all rows, 0 when there are none; null when the guess for
  /// this fit was too far off to be sure.
  std::optional<double> largest(Eigen::Index fit, const Eigen::VectorXd& combination) const;

 private:
  struct Batch {
    Eigen::VectorXd reach;              // largest |value| of every column
    std::vector<Eigen::MatrixXd> kept;  // per fit, rows x columns
    std::vector<double> rest;           // per fit, largest |residual| by the guess among the others
  };
  Eigen::MatrixXd guesses_;
  std::vector<Batch> batches_;
};

}  // namespace cablefit
