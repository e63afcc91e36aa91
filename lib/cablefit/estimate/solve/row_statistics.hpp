// All that the estimators need of millions of rows, in constant memory. The triangular factor of a
// streamed QR gives the estimates: it does not square the condition number. The Gram matrices of at
// most kMaxCells stretches of rows (fewer where rows are wide) give robust standard deviations and
// held-out blocks, for which their precision is sufficient.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <vector>

namespace cablefit {

/// Rows contain all columns of an equation side by side, regressors and responses alike. The solver
/// decides which is which, so one pass over a log serves every model fitted to it.
using Rows = Eigen::Ref<const Eigen::MatrixXd>;

/// R of [rows] = Q R, n_columns x n_columns, upper triangular (Golub & Van Loan, ch. 5; TSQR of
/// Demmel et al. 2012). The order in which blocks are added decides the last bits: keep it fixed.
class StreamingQr {
 public:
  explicit StreamingQr(Eigen::Index n_columns);
  void add(const Rows& rows);
  /// `scale`: factor of the other's rows.
  void add(const StreamingQr& other, double scale = 1);
  /// Adds rows of which the triangular factor is known, n_columns columns.
  void absorb(const Eigen::MatrixXd& r);
  const Eigen::MatrixXd& r() const { return r_; }

 private:
  Eigen::MatrixXd r_;
};

/// Gram matrix of the rows numbered [id * cell_rows, (id + 1) * cell_rows).
struct GramCell {
  Eigen::Index id = 0;
  Eigen::Index n_rows = 0;
  Eigen::MatrixXd gram;  ///< n_columns x n_columns, symmetric, full
};

/// The terms that cells add to a sum, as a series in time: n x n_columns, one row for each stretch
/// of time from the first cell to the last, zeros where no rows were used. Neighbours in the series
/// are then neighbours in time, as its autocovariance assumes.
Eigen::MatrixXd series_over_time(const std::vector<GramCell>& cells, Eigen::Index n_columns,
                                 const std::function<Eigen::RowVectorXd(const GramCell&)>& of_cell);

class RowStatistics {
 public:
  static constexpr Eigen::Index kMaxCells = 2048;

  /// Both numbers decide the length of a cell (at least one row). There are no cells when
  /// `with_cells` is off.
  RowStatistics(Eigen::Index n_columns, Eigen::Index expected_rows, bool with_cells = true);
  /// An empty accumulator of the same layout, for another thread or window.
  RowStatistics empty_copy() const;

  /// Rows with their numbers on the time grid (ascending, with gaps where rows were dropped), so
  /// that each cell is a stretch of time.
  void add(const Rows& rows, std::span<const Eigen::Index> numbers);
  /// Adds the rows of another accumulator, after those of this one. Takes its cells: those of a
  /// hand fill some hundred megabytes.
  void add(RowStatistics&& later);

  /// Joins rows of several equations with the same columns and time grid. Each row is multiplied by
  /// the root of its equation's weight; rows of one stretch of time share a cell.
  static RowStatistics weighted(std::span<const RowStatistics* const> equations,
                                std::span<const double> weights);

  Eigen::Index n_rows() const { return n_rows_; }
  Eigen::Index n_columns() const { return n_columns_; }
  Eigen::Index cell_rows() const { return cell_rows_; }
  const Eigen::MatrixXd& r() const { return qr_.r(); }
  const std::vector<GramCell>& cells() const { return cells_; }

 private:
  RowStatistics(Eigen::Index n_columns, bool with_cells, Eigen::Index cell_rows);
  void add_cell(GramCell&& cell);

  Eigen::Index n_columns_;
  Eigen::Index cell_rows_;
  bool with_cells_;
  Eigen::Index n_rows_ = 0;
  StreamingQr qr_;
  std::vector<GramCell> cells_;
};

}  // namespace cablefit
