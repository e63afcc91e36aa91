// Least squares by QR on columns of unit norm. Internal to design/.
#pragma once

#include <Eigen/Core>

namespace cablefit {

class ScaledSolver {
 public:
  /// rows x columns; `least_rows`: per column.
  ScaledSolver(const Eigen::MatrixXd& columns, Eigen::Index least_rows);
  /// False: too few rows, or columns that depend on each other; then nothing below makes sense.
  bool determined() const { return determined_; }
  const Eigen::VectorXd& norms() const { return norms_; }
  /// Columns x right-hand sides.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const;
  /// Root of diag (W'W)^-1.
  Eigen::VectorXd unit_sd() const;

 private:
  Eigen::VectorXd norms_;
  Eigen::MatrixXd q_, r_;  ///< thin factors of the scaled columns
  bool determined_ = false;
};

}  // namespace cablefit
