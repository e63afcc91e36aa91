// Rows of an equation kept for a second look, so that they need not be made again.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "cablefit/log/spill_file.hpp"
#include "cablefit/samples/rows/equation_rows.hpp"

namespace cablefit {

/// About a megabyte in memory, the rest in an unlinked temporary file. For equations that decimate
/// a lot: their rows are few against the samples they come from.
class RowArchive {
 public:
  /// Throws Error(output) when the temporary folder has no room.
  void append(const EquationBatch& batch);

  /// One value of every step-th row, counted over all batches, without reading the others.
  std::vector<double> every(Eigen::Index step, Eigen::Index column) const;

  /// look(rows, numbers) on every batch appended, in order.
  template <class Look>
  void for_each(Look look) const {
    Eigen::MatrixXd rows;
    for (const Batch& batch : batches_) {
      read(batch, rows);
      look(rows, std::span(batch.numbers));
    }
  }

 private:
  struct Batch {
    std::size_t place = 0;
    std::vector<Eigen::Index> numbers;
  };
  void read(const Batch& batch, Eigen::MatrixXd& rows) const;

  Eigen::Index n_columns_ = 0;
  std::vector<Batch> batches_;
  SpillFile values_;
};

}  // namespace cablefit
