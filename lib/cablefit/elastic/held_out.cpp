#include "cablefit/elastic/held_out.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>

namespace cablefit {
namespace {

// Least squares from a Gram matrix with scaled columns. Its precision (condition squared) is plenty
// for comparing models; estimates that are reported come from the QR.
Eigen::VectorXd solve_gram(const Eigen::MatrixXd& gram, const std::vector<Eigen::Index>& regressors,
                           const Eigen::VectorXd& response) {
  const auto p = static_cast<Eigen::Index>(regressors.size());
  Eigen::MatrixXd a(p, p);
  Eigen::VectorXd b(p), scale(p);
  for (Eigen::Index i = 0; i < p; ++i) {
    const double norm = std::sqrt(
        gram(regressors[static_cast<std::size_t>(i)], regressors[static_cast<std::size_t>(i)]));
    scale(i) = norm > 0 ? 1 / norm : 1;
  }
  for (Eigen::Index i = 0; i < p; ++i) {
    const Eigen::Index ri = regressors[static_cast<std::size_t>(i)];
    b(i) = scale(i) * gram.row(ri).dot(response);
    for (Eigen::Index j = 0; j < p; ++j)
      a(i, j) = scale(i) * scale(j) * gram(ri, regressors[static_cast<std::size_t>(j)]);
  }
  return scale.cwiseProduct(a.completeOrthogonalDecomposition().solve(b));
}

}  // namespace

HeldOut::HeldOut(const RowStatistics& rows)
    : cell_rows_(rows.cell_rows()),
      block_grams_(kHeldOutBlocks, Eigen::MatrixXd::Zero(rows.n_columns(), rows.n_columns())),
      block_rows_(kHeldOutBlocks, 0) {
  if (rows.cells().empty()) return;
  first_id_ = rows.cells().front().id;
  last_id_ = rows.cells().back().id;
  for (const GramCell& cell : rows.cells()) {
    const auto block = static_cast<std::size_t>(block_of(cell.id));
    block_grams_[block] += cell.gram;
    block_rows_[block] += cell.n_rows;
  }
}

Eigen::Index HeldOut::block_of(Eigen::Index cell_id) const {
  const Eigen::Index span = std::max<Eigen::Index>(1, last_id_ - first_id_ + 1);
  return std::clamp<Eigen::Index>((cell_id - first_id_) * kHeldOutBlocks / span, 0,
                                  kHeldOutBlocks - 1);
}

std::vector<Eigen::VectorXd> HeldOut::fits(const std::vector<Eigen::Index>& regressors,
                                           const Eigen::VectorXd& response) const {
  std::vector<Eigen::VectorXd> result;
  for (Eigen::Index fold = 0; fold < kHeldOutFolds; ++fold) {
    Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(response.size(), response.size());
    for (Eigen::Index block = 0; block < kHeldOutBlocks; ++block)
      if (block % kHeldOutFolds != fold) gram += block_grams_[static_cast<std::size_t>(block)];
    const Eigen::VectorXd x = solve_gram(gram, regressors, response);
    Eigen::VectorXd residual = response;
    for (std::size_t k = 0; k < regressors.size(); ++k)
      residual(regressors[k]) -= x(static_cast<Eigen::Index>(k));
    result.push_back(residual);
  }
  return result;
}

Eigen::VectorXd HeldOut::block_errors(const std::vector<Eigen::VectorXd>& fits) const {
  std::vector<double> errors;
  for (Eigen::Index block = 0; block < kHeldOutBlocks; ++block) {
    const auto k = static_cast<std::size_t>(block);
    if (block_rows_[k] == 0) continue;
    const Eigen::VectorXd& v = fits[static_cast<std::size_t>(block % kHeldOutFolds)];
    errors.push_back(std::max(0.0, v.dot(block_grams_[k] * v)) /
                     static_cast<double>(block_rows_[k]));
  }
  return Eigen::Map<Eigen::VectorXd>(errors.data(), static_cast<Eigen::Index>(errors.size()));
}

}  // namespace cablefit
