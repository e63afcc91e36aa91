#include "cablefit/samples/rows/row_archive.hpp"

namespace cablefit {

void RowArchive::append(const EquationBatch& batch) {
  if (batch.rows.rows() == 0) return;
  n_columns_ = batch.rows.cols();
  batches_.push_back({values_.size(), batch.numbers});
  values_.append({batch.rows.data(), static_cast<std::size_t>(batch.rows.size())});
}

void RowArchive::read(const Batch& batch, Eigen::MatrixXd& rows) const {
  rows.resize(static_cast<Eigen::Index>(batch.numbers.size()), n_columns_);
  values_.read(batch.place, {rows.data(), static_cast<std::size_t>(rows.size())});
}

}  // namespace cablefit
