#include "cablefit/samples/rows/row_archive.hpp"

namespace cablefit {

void RowArchive::append(const EquationBatch& batch) {
  if (batch.rows.rows() == 0) return;
  n_columns_ = batch.rows.cols();
  batches_.push_back({values_.size(), batch.numbers});
  values_.append({batch.rows.data(), static_cast<std::size_t>(batch.rows.size())});
}

std::vector<double> RowArchive::every(Eigen::Index step, Eigen::Index column) const {
  std::vector<double> chosen, values;
  Eigen::Index next = 0;  // in the batch
  for (const Batch& batch : batches_) {
    const auto n = static_cast<Eigen::Index>(batch.numbers.size());
    values.resize(batch.numbers.size());
    values_.read(batch.place + static_cast<std::size_t>(column * n), values);
    for (; next < n; next += step) chosen.push_back(values[static_cast<std::size_t>(next)]);
    next -= n;
  }
  return chosen;
}

void RowArchive::read(const Batch& batch, Eigen::MatrixXd& rows) const {
  rows.resize(static_cast<Eigen::Index>(batch.numbers.size()), n_columns_);
  values_.read(batch.place, {rows.data(), static_cast<std::size_t>(rows.size())});
}

}  // namespace cablefit
