#include "cablefit/samples/survey/sample_store.hpp"

namespace cablefit {

void SampleStore::append(std::size_t part, bool follows,
                         const Eigen::Ref<const Eigen::MatrixXd>& rows) {
  n_columns_ = rows.cols();
  pieces_.push_back({part, follows, rows.rows(), values_.size()});
  for (Eigen::Index k = 0; k < rows.cols(); ++k)
    values_.append({rows.col(k).data(), static_cast<std::size_t>(rows.rows())});
}

void SampleStore::read(const SamplePiece& piece, Eigen::MatrixXd& rows) const {
  rows.resize(piece.n_rows, n_columns_);
  values_.read(piece.place, {rows.data(), static_cast<std::size_t>(rows.size())});
}

}  // namespace cablefit
