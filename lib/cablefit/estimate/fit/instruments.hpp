// Regressors as instruments see them. Internal to estimate/; others set LinearProblem::instruments.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "cablefit/estimate/solve/row_statistics.hpp"

namespace cablefit {

/// F of the first stage from its partial R^2; below kStrongFirstStage instruments are weak
/// (Staiger & Stock 1997).
inline constexpr double kStrongFirstStage = 10;
double first_stage_f(double share, double effective_rows);

/// The space of the instruments Z among the rows, by a pivoted QR of their columns of R, scaled:
/// no normal equations. Without instruments everything is seen as it is.
class Instruments {
 public:
  Instruments(const RowStatistics& rows, const std::vector<Eigen::Index>& columns);

  /// Q'columns, Q an orthonormal basis of Z; `columns`: R times any combinations of the rows'
  /// columns. At least one row per column, 0 where there are fewer instruments.
  Eigen::MatrixXd project(const Eigen::MatrixXd& columns) const;
  /// n_columns x regressors: rows * this = P W, the projection of the regressors on Z.
  Eigen::MatrixXd score_columns(const RowStatistics& rows,
                                const std::vector<Eigen::Index>& regressors) const;

 private:
  std::vector<Eigen::Index> columns_;
  Eigen::MatrixXd basis_;         ///< Q, n x rank
  Eigen::MatrixXd coefficients_;  ///< Z * this = Q
};

}  // namespace cablefit
