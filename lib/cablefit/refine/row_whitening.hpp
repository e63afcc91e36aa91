// Rows freed of what they have in common with the rows before: beside a torque that wanders, what
// changes faster than it is told better than rows that count alike tell it (generalised least
// squares; Aitken 1936). Internal to refine/.
#pragma once

#include <array>
#include <vector>

#include "cablefit/refine/base_rows.hpp"

namespace cablefit {

/// Linear prediction of a row from the rows of its kind before it, as its residual goes on in time.
/// A prediction begins anew after a hole and with every block, so that blocks stay apart.
class RowWhitening {
 public:
  /// Rows stay as they are.
  RowWhitening() = default;

  /// `autocovariance`: of each kind's residual, (N m)^2, by lag in rows; empty: rows of the kind
  /// stay as they are. Where it is not positive definite the order ends.
  RowWhitening(const std::array<Eigen::VectorXd, kRowKinds>& autocovariance, double block_seconds);

  /// Whether any row changes.
  bool is_needed() const;

  /// What is not predicted of `columns` (any, a row for each of `rows`; `smoothing`: of their
  /// stretch). A row that few are before counts less, as much as it is told worse.
  Eigen::MatrixXd of(const KindRows& rows, const Smoothing& smoothing,
                     const Eigen::MatrixXd& columns) const;

 private:
  struct Prediction {
    Eigen::VectorXd from;  ///< the row before, the one before that, ...
    double weight = 1;     ///< sd of what the longest prediction leaves, in those of this one
  };
  /// Of each kind, by the number of rows before; empty: rows stay as they are.
  std::array<std::vector<Prediction>, kRowKinds> predictions_;
  double block_seconds_ = 0;
};

}  // namespace cablefit
